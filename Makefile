# Everything runs from a clean checkout with cargo and Python 3.11 or later; .venv and target are made here.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
WHEELS := target/wheels
RIVALS := target/rivals-venv

.PHONY: demo test lint bench sweep bounds rivals docs wheel clean

demo: $(VENV)/installed  ## build and install the wheel, run the scenes, print the table, draw the pictures
	$(BIN)/python examples/demo.py

test: lint $(VENV)/installed  ## everything that CI runs
	cargo test --workspace --quiet
	$(BIN)/python tests/reference/torque_free.py tests/data/torque_free.json
	$(BIN)/python examples/scenes/make_scenes.py --check
	$(BIN)/python examples/bounds.py --scenes 120
	$(BIN)/python -m pytest -q crates/py/tests
	$(BIN)/python -m pytest -q --doctest-glob='*.md' README.md docs

lint:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --quiet -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --workspace --no-deps --document-private-items --quiet

bench:  ## criterion groups by order
	cargo bench --workspace

sweep: $(VENV)/installed  ## series against closed form by order, σ/σ_sep and β: docs/data/sweep.csv, picture and table of its page; a minute
	$(BIN)/python examples/sweep.py

bounds: $(VENV)/installed  ## errors of 3000 random scenes against their bounds; one to two minutes
	$(BIN)/python examples/bounds.py

rivals: $(RIVALS)/installed  ## the normal form against python-flint, SymPy and SymEngine: a table of ratios, in out/ too
	$(RIVALS)/bin/python benches/rivals/normal_form.py

$(RIVALS)/installed: $(RIVALS)/ready $(VENV)/installed
	$(RIVALS)/bin/python -m pip install --quiet --force-reinstall --no-deps $(WHEELS)/andoyer-*.whl
	touch $@

$(RIVALS)/ready: benches/rivals/requirements.txt
	$(PYTHON) -m venv $(RIVALS)
	$(RIVALS)/bin/python -m pip install --quiet --requirement benches/rivals/requirements.txt
	touch $@

docs:  ## the Rust documentation
	RUSTDOCFLAGS='-D warnings' cargo doc --workspace --no-deps

wheel: $(VENV)/installed

# The wheel is rebuilt when any source of it is newer than the installation.
SOURCES := Cargo.toml Cargo.lock README.md $(shell find crates -name '*.rs' -o -name '*.py' -o -name '*.pyi' -o -name '*.toml' -o -name '*.md')
$(VENV)/installed: $(VENV)/ready $(SOURCES)
	rm -rf $(WHEELS)
	$(BIN)/maturin build --release --locked --quiet --manifest-path crates/py/Cargo.toml --interpreter $(BIN)/python --out $(WHEELS)
	$(BIN)/python -m pip install --quiet --force-reinstall --no-deps $(WHEELS)/andoyer-*.whl
	touch $@

$(VENV)/ready: crates/py/requirements.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --requirement crates/py/requirements.txt
	touch $@

clean:
	rm -rf target $(VENV) out
