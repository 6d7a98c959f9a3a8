"""What commands advise helps: the next command for a new case, and another name where a
folder is in the way.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from vibroimpact.cli import main


@pytest.fixture
def run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> object:
    """Return a function that runs a command in an empty folder, and returns all that it prints."""
    monkeypatch.chdir(tmp_path)

    def command(*arguments: str) -> str:
        monkeypatch.setattr("sys.argv", ["vibroimpact", *arguments])
        with pytest.raises(SystemExit):
            main()
        written = capsys.readouterr()
        return written.out + written.err

    return command


@pytest.mark.parametrize(
    ("source", "advice"),
    [
        ("paper:type1-theory", "run it: vibroimpact run mine.toml"),
        ("paper:sweep", "run the study: vibroimpact sweep mine.toml"),
        ("signals:river-plate", "compute the data set: vibroimpact dataset mine.toml"),
        ("paper:calibration", "calibrate it: vibroimpact calibrate mine.toml"),
    ],
)
def test_a_new_case_comes_with_the_command_that_it_is_for(
    run: object, source: str, advice: str
) -> None:
    assert callable(run)
    assert advice in run("new", "mine", "--from", source)


def test_a_folder_in_the_way_is_not_replaced(run: object, tmp_path: Path) -> None:
    assert callable(run)
    (tmp_path / "mine.toml").mkdir()
    for force in ((), ("--force",)):
        assert "mine.toml is a folder; take another name" in run("new", "mine", *force)
        assert "mine.toml is a folder; name a file for the table" in run(
            "features", "records", "-o", "mine.toml", *force
        )


def test_the_list_of_formats_takes_no_options_of_an_export(run: object) -> None:
    assert callable(run)
    assert "--formats lists the formats, and takes no --to, -o, --match or --force" in run(
        "export", "--formats", "--force"
    )
