# make demo, make test, ...: each sets up $(VENV) by itself the first time, with the newest
# supported Python it finds. Choose another folder or Python with VENV=... or PYTHON=...

VENV ?= .venv
PYTHON ?=
RUN := $(VENV)/bin/python
export PYTHONDONTWRITEBYTECODE :=  # the suite starts Python a hundred times
READY := $(VENV)/.ready
DEMO := $(VENV)/.ready-demo

.DEFAULT_GOAL := help
.PHONY: help demo docs quick test suite nightly lint types kernels wheel clean

help:  ## list the targets
	@sed -n 's/^\([a-z]*\):.*## */  make \1\t/p' $(firstword $(MAKEFILE_LIST))

demo: $(if $(wildcard $(READY)),$(READY),$(DEMO))  ## run the demonstration
	$(RUN) -m frames.demo

docs: $(READY)  ## build the site into build/docs
	$(RUN) -m sphinx -W --keep-going -b html -c docs . build/docs

quick: $(READY)  ## the physics and one path through each door: under a minute, once kernels are compiled
	$(RUN) -m pytest -m quick -n auto --maxprocesses 4 --dist worksteal -q

test: $(READY)  ## lint, types and all tests
	$(MAKE) --no-print-directory lint
	$(MAKE) --no-print-directory -j 2 types suite

suite: kernels
	$(RUN) -m pytest -n auto --maxprocesses 4 --dist worksteal

nightly: $(READY)  ## what takes minutes: compiling, the site, more random cases, all reviewed projects, xara
	$(RUN) -m pytest -m nightly
	$(RUN) -m pip install --disable-pip-version-check --quiet "opensees>=0.1.31" || \
		echo "opensees, the library of xara, cannot be installed; its tests are skipped"
	$(RUN) -m pytest tests/integration/test_xara.py

kernels: $(READY)  ## compile the kernels of usual analyses, once
	$(RUN) -m frames.precompile

lint: $(READY)  ## ruff: rules and format
	$(RUN) -m ruff check .
	$(RUN) -m ruff format --check .

types: $(READY)  ## mypy, strict, on both packages
	$(RUN) -m mypy

wheel: $(READY)  ## build a wheel that brings its compiled kernels along, into dist
	$(RUN) -m pip install --disable-pip-version-check --quiet build
	LIR_BUILD_KERNELS=1 $(RUN) -m build --wheel

clean:  ## remove caches, builds and the virtual environment
	rm -rf .mypy_cache .pytest_cache .ruff_cache .hypothesis build dist demo docs/generated docs/api/generated
	find . -name __pycache__ -not -path './.git/*' -prune -exec rm -rf {} +
	@if [ -f "$(VENV)/pyvenv.cfg" ]; then echo "rm -rf $(VENV)"; rm -rf "$(VENV)"; fi

$(READY): pyproject.toml
	@PYTHON="$(PYTHON)" sh .ci/venv "$(VENV)"
	@touch "$@"

$(DEMO): pyproject.toml
	@PYTHON="$(PYTHON)" sh .ci/venv "$(VENV)" demo
	@touch "$@"
