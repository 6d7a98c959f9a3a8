"""What is wrong with built pages: dead links, pictures without words, what comes from a
network, pages that are heavy or lead nowhere.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

MOST_BYTES = 3_000_000
"""What a page and its pictures may weigh; films, and scripts and fonts that all pages
share, do not count.
"""

_ENDS = {"search.html", "genindex.html"}
"""Pages that stand beside the order of reading."""


@dataclass
class Page(HTMLParser):
    """What a page contains, as far as it is examined."""

    path: Path
    names: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    pictures: list[str] = field(default_factory=list)
    loaded: list[str] = field(default_factory=list)
    without_words: list[str] = field(default_factory=list)
    leads_on: bool = False

    def __post_init__(self) -> None:
        super().__init__()
        self.text = self.path.read_text(encoding="utf-8")
        self.feed(self.text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        has = {key: value or "" for key, value in attrs}
        self.names |= {has[key] for key in ("id", "name") if key in has}
        match tag:
            case "a" if "href" in has:
                self.links.append(has["href"])
                self.leads_on |= "right-next" in has.get("class", "")
            case "img" if not has["src"].startswith("data:"):
                self.pictures.append(has["src"])
            case "script" | "iframe" | "video" | "source" if "src" in has:
                self.loaded.append(has["src"])
            case "link" if has.get("rel") in ("stylesheet", "preload", "icon"):
                self.loaded.append(has["href"])
        if tag == "img" and not has.get("alt", "").strip():
            self.without_words.append(has["src"][:80])

    def size(self) -> int:
        """Return what the page weighs with its pictures [bytes]."""
        pictures = {
            self.path.parent / unquote(urlsplit(picture).path)
            for picture in self.pictures
            if not urlsplit(picture).scheme
        }
        return len(self.text.encode()) + sum(
            picture.stat().st_size for picture in pictures if picture.is_file()
        )


def read_pages(site: Path) -> dict[Path, Page]:
    """Return the pages of a site."""
    return {
        path: Page(path)
        for path in sorted(site.resolve().rglob("*.html"))
        if "_static" not in path.relative_to(site.resolve()).parts
    }


def page_faults(pages: dict[Path, Page]) -> list[str]:
    """Return a sentence for each fault of the pages of a site."""
    faults = []
    for path, page in pages.items():
        found = [f"a picture without words: {picture}" for picture in page.without_words]
        found += [
            f"loaded from a network: {loaded}"
            for loaded in page.loaded + page.pictures
            if urlsplit(loaded).netloc
        ]
        found += [
            f"there is no {file}"
            for file in page.loaded + page.pictures
            if not _leads(file, page, {})
        ]
        found += [f"a dead link: {link}" for link in page.links if not _leads(link, page, pages)]
        if page.size() > MOST_BYTES:
            found.append(f"it weighs {page.size() / 1e6:.1f} MB with its pictures")
        faults += [f"{path.name}: {fault}" for fault in found]
    ends = [
        path.name for path, page in pages.items() if not page.leads_on and path.name not in _ENDS
    ]
    return faults + (
        [f"more than one page leads no further: {', '.join(ends)}"] if len(ends) > 1 else []
    )


def _leads(link: str, page: Page, pages: dict[Path, Page]) -> bool:
    """Return whether a link leads to a file, and to a name in it if it is a page; a link
    out of the site is taken to.
    """
    to = urlsplit(link)
    if to.scheme or to.netloc:
        return True
    target = (page.path.parent / unquote(to.path)).resolve() if to.path else page.path
    if not to.fragment or target not in pages:
        return target.is_file()
    return unquote(to.fragment) in pages[target].names
