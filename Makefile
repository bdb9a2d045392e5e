# All commands of the project. They need Rust (with rustfmt and clippy), Python >= 3.11 and make;
# everything else is installed into .venv at first use.

PYTHON ?= python3
OPTIONS ?=
BASELINE ?= last
CASES ?= 1000

TARGET := $(or $(CARGO_TARGET_DIR),target)
VENV := .venv
BIN := $(VENV)/bin
SOURCES := Cargo.toml Cargo.lock pyproject.toml $(wildcard LICENSE-*) \
	$(shell find src python -type f ! -name '*.py[cd]' ! -name '*.so')

export VIRTUAL_ENV := $(CURDIR)/$(VENV)
export PYO3_PYTHON := $(CURDIR)/$(BIN)/python
unexport CONDA_PREFIX PYTHONHOME PYTHONPATH

# Messages of panics name the sources of other crates: without the home folder of who builds them.
# All release builds have this flag, so that they share those crates. Cargo splits flags at spaces.
CARGO_HOME ?= $(HOME)/.cargo
REMAPPED := $(if $(word 2,$(CARGO_HOME)),,CARGO_BUILD_RUSTFLAGS=--remap-path-prefix=$(CARGO_HOME)=cargo)

# Stamps: empty files that record what has been installed into .venv.
BUILD := $(VENV)/.build
DEV := $(VENV)/.dev
DOCS := $(VENV)/.docs
WHEEL := $(VENV)/.wheel

.PHONY: help demo test test-rust test-python quick check check-rust check-python bench counts compare-counts fuzz peers references kappa constants torch develop stubs docs links licences publishable

help: ## list these commands
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-14s %s\n", $$1, $$2 }' Makefile

demo: $(WHEEL) ## solve the paper's cases: a table here, figures and CSV under out/
	PYTHONPATH=examples $(BIN)/python -m paper --out out

test: test-rust test-python ## Rust tests and doctests, a crate that depends on nacre, pytest on the wheel

# With PYO3_PYTHON=none, the crate that depends on nacre builds only if nacre needs no Python.
test-rust: $(BUILD)
	@if cargo nextest --version >/dev/null 2>&1; \
	then set -x; cargo nextest run --features serde --run-ignored all; \
	else set -x; cargo test --tests --examples --features serde -- --include-ignored; fi
	cargo test --doc --features serde
	PYO3_PYTHON=none cargo run --manifest-path tests/dependent/Cargo.toml --target-dir $(TARGET)

# Neighbours share what they have solved: each process takes a row of them, and steals what the other has left.
test-python: $(WHEEL) $(DEV)
	$(BIN)/pytest -n 2 --dist worksteal

# Without what takes more than half a second each in Rust, or seconds each in Python: two minutes once built.
quick: $(WHEEL) $(DEV) ## the tests of a daily edit: those of Rust and Python that are fast
	cargo test --tests --features serde
	$(BIN)/pytest -q -n 2 --dist worksteal -m "not slow"

check: check-rust check-python ## formatting, lints, types, house rules, documentation links, stubs; changes nothing

check-rust: $(BUILD)
	cargo fmt --check
	cargo fmt --check --manifest-path tests/dependent/Cargo.toml
	cargo clippy --all-targets -- -D warnings
	cargo clippy --all-targets --features python,serde -- -D warnings
	@for target in wasm32-unknown-unknown wasm32-unknown-emscripten; do \
		if [ -d "$$(rustc --print sysroot)/lib/rustlib/$$target" ]; then cargo check --target $$target; \
		else echo "$$target is not installed: not checked"; fi; \
	done
	RUSTDOCFLAGS='-D warnings' cargo doc --no-deps
	$(BIN)/python packaging/licences.py --check
	@if [ -d "$$(rustc --print sysroot)/lib/rustlib/wasm32-unknown-emscripten/lib" ]; \
	then set -x; cargo check --target wasm32-unknown-emscripten --features serde; \
	PYO3_CROSS_PYTHON_VERSION=3.14 PYO3_NO_PYTHON=1 cargo check --target wasm32-unknown-emscripten --features python,serde; \
	else echo "wasm32-unknown-emscripten is not checked: rustup target add wasm32-unknown-emscripten"; fi

check-python: $(WHEEL) $(DEV) $(DOCS)
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest nacre._core
	$(BIN)/python tests/house.py
	$(BIN)/python tests/metadata.py
	$(BIN)/python tests/wheel.py $(TARGET)/wheels/*.whl
	$(BIN)/lint-imports

bench: ## time the Rust benchmarks, print the change since the last run, append to benches/history.csv
	@find $(TARGET)/criterion -type d -name new -prune -exec rm -r {} + 2>/dev/null || true
	$(REMAPPED) cargo bench --bench '*' -- --save-baseline $(BASELINE)
	$(PYTHON) benches/track.py $(TARGET)/criterion benches/history.csv

# Another load of the machine does not change counts, so that they tell a change of a few per cent, which times do not.
counts: ## count instructions and convolutions of small problems under Valgrind: benches/counts.csv, in two minutes once built
	$(REMAPPED) $(PYTHON) benches/counts.py

compare-counts: ## compare them with benches/counts.csv: a rise by more than 2 % is an error; changes nothing
	$(REMAPPED) $(PYTHON) benches/counts.py --compare

fuzz: $(WHEEL) $(DEV) ## random contacts, calls, files and indentations: CASES=1000 of each kind, more than ten thousand in all
	NACRE_FUZZ=$(CASES) cargo test --test contacts --test frictions fuzz -- --include-ignored
	NACRE_FUZZ=$(CASES) $(BIN)/pytest tests/python/*/test_fuzz*.py

# The other solvers are installed into a separate environment under target/peers.
peers: $(WHEEL) ## compare nacre with other solvers: docs/peers.md; OPTIONS=--quick takes four minutes
	PYTHONPATH=benches $(PYTHON) -m peers --target $(TARGET) $(OPTIONS)

# The generators know nothing of nacre. OPTIONS=--write replaces the stored numbers; OPTIONS=jkr runs one generator.
references: $(BUILD) ## recompute the reference numbers of the tests and compare them with tests/data, in forty minutes
	$(BIN)/python -m pip install --quiet --group references
	$(BIN)/python tests/data/make $(OPTIONS)

kappa: $(WHEEL) $(DEV) ## area of rough contacts of bare and coated bodies: docs/kappa.csv and its picture, in three minutes
	$(BIN)/python benches/kappa.py

constants: $(BUILD) ## halve and double the constants of the solver that were found by trial: docs/constants.csv, in an hour
	$(BIN)/python benches/constants.py

# PyTorch is large: it is installed into a separate environment under target/torch.
torch: $(WHEEL) ## tests of nacre.torch, with PyTorch in an environment of its own
	$(PYTHON) -m venv $(TARGET)/torch
	$(TARGET)/torch/bin/python -m pip install --quiet "$$(echo $(TARGET)/wheels/*.whl)[torch]" 'pytest>=9'
	$(TARGET)/torch/bin/python -m pip install --quiet --force-reinstall --no-deps $(TARGET)/wheels/*.whl
	$(TARGET)/torch/bin/python -m pytest tests/python/design/test_functions.py

develop: $(DEV) ## build in place: changed Python files count at once, changed Rust after the next make develop
	rm -f $(WHEEL)
	$(REMAPPED) $(BIN)/maturin develop --release
	$(BIN)/python -m pip install --quiet 'nacre-contact[all]'  # the extras of the nacre just installed

stubs: $(WHEEL) $(DEV) ## compare the type stubs with the compiled module
	$(BIN)/python -m mypy.stubtest nacre._core

licences: ## collect the licences of the crates in the compiled module: LICENSE-THIRD-PARTY
	$(PYTHON) packaging/licences.py

# Nothing is uploaded: cargo and twine say whether the crate, the wheel and the source distribution would be accepted.
publishable: $(WHEEL) $(DEV) ## dry run of both publications: the crate and the distribution
	cargo publish --locked --dry-run --target-dir $(TARGET)/publish
	rm -rf $(TARGET)/publish-source
	mkdir -p $(TARGET)/publish-source
	git ls-files -z | xargs -0 cp --parents -t $(TARGET)/publish-source
	$(BIN)/python tests/metadata.py --links $(TARGET)/publish-source/README.md
	$(BIN)/maturin sdist --manifest-path $(TARGET)/publish-source/Cargo.toml --out $(TARGET)/wheels
	$(BIN)/twine check --strict $(TARGET)/wheels/*.whl $(TARGET)/wheels/*.tar.gz

# The pictures of the gallery are computed; a warning is an error. The Rust documentation goes to rust/.
docs: $(WHEEL) $(DOCS) ## build the documentation as a site: docs/_build/html/index.html
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet -d docs/_build/doctrees docs docs/_build/html
	RUSTDOCFLAGS='-D warnings' cargo doc --no-deps
	rm -rf docs/_build/html/rust
	cp -R $(TARGET)/doc docs/_build/html/rust

# Links to other sites need the network; those between pages are checked by make docs, too.
links: $(WHEEL) $(DOCS) ## check the links of the documentation, to other sites too
	NACRE_DOCS_ONLINE=1 $(BIN)/sphinx-build --fail-on-warning --keep-going --quiet -D plot_gallery=0 -b linkcheck docs docs/_build/links

# pip knows --group since version 25.1.
$(BUILD): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit("nacre needs Python >= 3.11; make PYTHON=..." if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet 'pip>=25.1'
	$(BIN)/python -m pip install --quiet --group build
	@touch $@

$(DEV): $(BUILD)
	$(BIN)/python -m pip install --quiet --group dev
	@touch $@

$(DOCS): $(BUILD)
	$(BIN)/python -m pip install --quiet --group docs
	@touch $@

# Tests run on the wheel, as users get it, and not on the checkout.
$(WHEEL): $(SOURCES) $(BUILD)
	rm -rf $(TARGET)/wheels
	$(REMAPPED) $(BIN)/maturin build --release --interpreter $(BIN)/python --out $(TARGET)/wheels
	$(BIN)/python -m pip install --quiet --force-reinstall --no-deps $(TARGET)/wheels/*.whl
	$(BIN)/python -m pip install --quiet "$$(echo $(TARGET)/wheels/*.whl)[all]"
	@touch $@
