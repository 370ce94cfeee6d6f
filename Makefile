# make demo, make test, ...: each sets up $(VENV) by itself the first time, with the newest
# supported Python it finds. Choose another folder or Python with VENV=... or PYTHON=...

VENV ?= .venv
PYTHON ?=
RUN := $(VENV)/bin/python
READY := $(VENV)/.ready

.DEFAULT_GOAL := help
.PHONY: help demo docs test lint types clean

help:  ## list the targets
	@sed -n 's/^\([a-z]*\):.*## */  make \1\t/p' $(firstword $(MAKEFILE_LIST))

demo: $(READY)  ## run the demonstration
	$(RUN) -m frames.demo

docs: $(READY)  ## build the site into build/docs
	$(RUN) -m sphinx -W --keep-going -b html -c docs . build/docs

test: lint types  ## lint, types and all tests
	$(RUN) -m pytest -n auto --maxprocesses 4 --dist worksteal

lint: $(READY)  ## ruff: rules and format
	$(RUN) -m ruff check .
	$(RUN) -m ruff format --check .

types: $(READY)  ## mypy, strict, on both packages
	$(RUN) -m mypy

clean:  ## remove caches, builds and the virtual environment
	rm -rf .mypy_cache .pytest_cache .ruff_cache .hypothesis build dist demo docs/generated docs/api/generated
	find . -name __pycache__ -not -path './.git/*' -prune -exec rm -rf {} +
	@if [ -f "$(VENV)/pyvenv.cfg" ]; then echo "rm -rf $(VENV)"; rm -rf "$(VENV)"; fi

$(READY): pyproject.toml
	@PYTHON="$(PYTHON)" sh .ci/venv "$(VENV)"
	@touch "$@"
