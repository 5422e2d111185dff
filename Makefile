# For a fresh clone: `make demo` shows lobula at work, `make test` runs its tests.
# Needed: Python 3.11 or newer, pip, make, a C compiler. Everything is installed into $(VENV).

PYTHON ?= python3
VENV ?= .venv

IN = $(VENV)/bin/python
NEW_ENOUGH = import sys; sys.version_info >= (3, 11) or sys.exit("lobula needs Python 3.11 or newer: make PYTHON=...")
# setuptools packs whatever lies in build/, files that were deleted since included
INSTALL = rm -rf build && $(IN) -m pip install --quiet

.PHONY: demo test lint firmware-test clean

demo: $(IN)
	$(INSTALL) ".[plot]"
	mkdir -p out
	$(IN) -m lobula demo --out out/demo.png

test: $(IN)
	$(INSTALL) ".[test]"
	$(IN) -m pytest

lint: $(IN)
	$(INSTALL) ".[dev]"
	$(IN) -m ruff check .
	$(IN) -m ruff format --check .
	$(IN) -m mypy

# The core on an emulated Cortex-M4F; Debian's packages gcc-arm-none-eabi, libnewlib-arm-none-eabi and qemu-system-arm.
FRAMES = 600
firmware-test: $(IN)
	$(INSTALL) "."
	$(IN) firmware/on_qemu.py --frames $(FRAMES)

clean:
	rm -rf $(VENV) build dist out

# some Pythons come without ensurepip, Debian's bare python3 for one: then pip itself makes the environment's pip
$(IN):
	@$(PYTHON) -c '$(NEW_ENOUGH)'
	$(PYTHON) -m venv $(VENV) || { $(PYTHON) -m venv --clear --without-pip $(VENV) \
		&& $(PYTHON) -m pip --python $(IN) install --quiet pip; }
