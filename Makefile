# make demo      install into .venv and run the paper's Type 1
# make test      install the dependencies of the tests and run the default suite
# make test-slow run the slow tests, as in CI
# make test-whole run the slow tests and those of pages on whole populations of cases, and tests that repeat others at greater cost
# make test-page run the tests of pages in Chromium, which is installed by apt-get if it is missing
# make test-peers   compare with LAMMPS, EXUDYN, MuJoCo (which it installs) and YADE (if it is installed)
# make test-lowest   test with the lowest allowed versions of the dependencies
# make package  build the sdist and from it the wheel, and test the wheel in an empty environment without extras
# make check     lint, formatting and types, as in CI
# make bench     run the benchmarks
# make docs      generate the pages of the contact laws, the table of features, the names for shell completion, and the types of the resolved case
# make docs-site build the documentation site into site/, which can be read offline: open site/index.html; its gallery tests the examples
# make ci        what continuous integration runs
# make validation run all comparisons except those with other programs, and generate the validation page
# make reproduce reproduce the paper, and generate its page of the documentation
# make help      print this list

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
OUTPUT := vibroimpact-demo
VIBROIMPACT_CHROMIUM ?= /usr/bin/chromium
CHROMIUM := $(VIBROIMPACT_CHROMIUM)

# Compiled modules are kept: without them each of the many processes that tests start compiles the whole package again, and each
# worker rewrites the assertions of all tests.
unexport PYTHONDONTWRITEBYTECODE
# tests are computed in a process a core
test test-slow test-page test-lowest docs-site validation: export OPENBLAS_NUM_THREADS = 1

.PHONY: help demo test test-slow test-whole test-page chromium test-peers test-lowest package check bench docs docs-site validation reproduce ci ci-beside-pages clean

demo: $(VENV)/installed
	$(BIN)/vibroimpact demo --output $(OUTPUT) --force

test: $(VENV)/installed-test
	$(BIN)/pytest -m "not slow and not peers and not page" -n auto --dist loadfile

test-slow: $(VENV)/installed-test
	$(BIN)/pytest -m "slow and not peers and not page" -n auto --dist worksteal $(WHOLE)

test-whole: WHOLE := --whole
test-whole: test-slow test-page

test-page: $(VENV)/installed-page chromium
	VIBROIMPACT_CHROMIUM="$(CHROMIUM)" $(BIN)/pytest -m page tests/page --reruns 2 --only-rerun BrowserStalled $(WHOLE)

chromium:
	@test -x "$(CHROMIUM)" || { \
	  echo "installing Chromium by apt-get"; \
	  as_root=$$(test "$$(id -u)" = 0 || echo sudo); \
	  { $$as_root apt-get update -qq && $$as_root apt-get install -y -qq chromium; } && test -x "$(CHROMIUM)"; } || { \
	  echo "There is no $(CHROMIUM), and apt-get can't install it. Install Chromium and name it:" >&2; \
	  echo "make test-page VIBROIMPACT_CHROMIUM=/path/of/chromium" >&2; exit 1; }

test-peers: $(VENV)/installed-peers
	$(BIN)/pytest -m peers

$(VENV)-lowest/installed: $(VENV)/installed-package
	$(BIN)/uv venv --quiet --clear --python $(BIN)/python $(VENV)-lowest
	$(BIN)/uv pip install --quiet --python $(VENV)-lowest/bin/python --resolution lowest-direct --editable . --group test
	touch $@

test-lowest: $(VENV)-lowest/installed
	$(VENV)-lowest/bin/python -m pytest -m "not slow and not peers and not page" -n auto --dist loadfile

package: $(VENV)/installed-package
	rm -rf dist build/tried
	$(BIN)/python -m build --installer uv --outdir dist .  # the wheel is built from the sdist
	$(BIN)/twine check --strict dist/*
	$(BIN)/uv venv --quiet --python $(BIN)/python build/tried
	$(BIN)/uv pip install --quiet --python build/tried/bin/python dist/*.whl
	cd build/tried && bin/vibroimpact demo --output demo && bin/vibroimpact run paper:type3 -o type3 && bin/vibroimpact doctor

check: $(VENV)/installed-lint
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: $(VENV)/installed
	for script in benchmarks/bench_*.py; do $(BIN)/python $$script || exit 1; done

docs: $(VENV)/installed
	$(BIN)/python -m vibroimpact.cases.sections.resolved_types
	$(BIN)/python -m vibroimpact.law_sheets.pages docs
	$(BIN)/python -m vibroimpact.cli.completion_words
	$(BIN)/python -m vibroimpact.cli.feature_page docs

docs-site: $(VENV)/installed-docs
	$(BIN)/sphinx-build --fresh-env --nitpicky --fail-on-warning --keep-going -d build/doctrees docs site

validation: $(VENV)/installed-test
	$(BIN)/pytest -m "not peers" tests/verification tests/published -n auto --dist worksteal --whole --validation tests/validation.jsonl
	$(BIN)/python tests/validation_page.py

reproduce: $(VENV)/installed
	$(BIN)/vibroimpact reproduce -o vibroimpact-paper --force
	$(BIN)/python -m vibroimpact.paper.report.docs_page vibroimpact-paper docs

# One environment for all stages, and stages of one process side by side: pages in a browser beside linter, package and site.
ci: $(VENV)/installed-ci
	$(MAKE) -j2 --output-sync=target test-page ci-beside-pages
	$(MAKE) test
	$(MAKE) test-slow

ci-beside-pages:
	$(MAKE) check
	$(MAKE) package
	$(MAKE) docs-site

$(VENV)/bin/python:
	@command -v $(PYTHON) >/dev/null || { \
	  echo "vibroimpact needs Python 3.11 or newer, and there is no $(PYTHON)." >&2; \
	  echo "Install it and name it: make PYTHON=python3.11 $(or $(MAKECMDGOALS),demo)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "vibroimpact needs Python 3.11 or newer, and $(PYTHON) is $$($(PYTHON) --version 2>&1)." >&2; \
	  echo "Install it and name it: make PYTHON=python3.11 $(or $(MAKECMDGOALS),demo)" >&2; exit 1; }
	@echo "making $(VENV) and installing; this takes a minute the first time"
	@$(PYTHON) -m venv $(VENV)
	@$(BIN)/python -m pip install --quiet --upgrade "pip>=25.1"

$(VENV)/installed: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable .
	touch $@

$(VENV)/installed-%: pyproject.toml | $(VENV)/bin/python
	$(BIN)/python -m pip install --quiet --editable . --group $*
	touch $@ $(VENV)/installed $(if $(filter ci,$*),$(foreach group,test page docs lint package,$(VENV)/installed-$(group)))

help:
	@sed -n 's/^# //p' Makefile

clean:
	rm -rf $(VENV) $(VENV)-lowest build dist site docs/gallery docs/reference .pytest_cache .mypy_cache .ruff_cache .hypothesis
