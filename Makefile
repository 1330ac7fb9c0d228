# Everything runs from a clean checkout with cargo and Python 3.11 or later; .venv and target are made here.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
WHEELS := target/wheels
RIVALS := target/rivals-venv
COPY_DEPENDENCIES := org.apache.maven.plugins:maven-dependency-plugin:3.8.1:copy-dependencies

.PHONY: demo test lint bench sweep bounds rivals rivals-normal-form rivals-propagation docs docs-test package wheel clean

demo: $(VENV)/installed  ## build and install the wheel, run the scenes, print the table, draw the pictures
	$(BIN)/python examples/demo.py

test: lint $(VENV)/installed $(VENV)/tested docs-test  ## everything that CI runs
	cargo test --workspace --quiet
	$(BIN)/python tests/reference/torque_free.py tests/data/torque_free.json
	$(BIN)/python examples/scenes/make_scenes.py --check
	$(BIN)/python examples/bounds.py --scenes 120
	$(BIN)/python -m pytest -q crates/py/tests
	mkdir -p out
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

rivals: rivals-normal-form rivals-propagation  ## both tables of ratios, in out/ too

rivals-normal-form: $(RIVALS)/normal-form $(RIVALS)/installed  ## the normal form against python-flint, SymPy and SymEngine
	$(RIVALS)/bin/python benches/rivals/normal_form.py

rivals-propagation: $(RIVALS)/propagation $(RIVALS)/installed $(RIVALS)/orekit/ready  ## propagation against heyoka, SciPy, ode_solvers and, where there is Maven, Orekit
	RUSTFLAGS='-C target-cpu=native' cargo build --release --locked --quiet --manifest-path benches/rivals/ode_solvers/Cargo.toml --target-dir $(RIVALS)/ode_solvers
	$(RIVALS)/bin/python benches/rivals/propagation.py --ode-solvers $(RIVALS)/ode_solvers/release/ode-solvers-rival --orekit $(RIVALS)/orekit

$(RIVALS)/installed: $(RIVALS)/made $(VENV)/installed
	$(RIVALS)/bin/python -m pip install --quiet --force-reinstall --no-deps $(WHEELS)/andoyer-*.whl
	touch $@

$(RIVALS)/made:
	$(PYTHON) -m venv $(RIVALS)
	touch $@

$(RIVALS)/normal-form: benches/rivals/requirements.txt $(RIVALS)/made
	$(RIVALS)/bin/python -m pip install --quiet --requirement $<
	touch $@

$(RIVALS)/propagation: benches/rivals/requirements-propagation.txt $(RIVALS)/made
	$(RIVALS)/bin/python -m pip install --quiet --requirement $<
	touch $@

# Without Maven and Java the folder stays empty, and the table says so.
$(RIVALS)/orekit/ready: benches/rivals/orekit/pom.xml $(RIVALS)/made
	mkdir -p $(@D)
	if command -v mvn && command -v java; then mvn --quiet --batch-mode --file $< $(COPY_DEPENDENCIES) -DoutputDirectory=$(abspath $(@D)); fi
	touch $@

docs: $(VENV)/documented  ## the site in target/site, the Rust documentation in it; warnings are errors, and the network is not used
	$(BIN)/python docs/_ext/rustdoc.py --check
	RUSTDOCFLAGS='-D warnings' cargo doc --no-deps --quiet -p andoyer-series -p andoyer-propagate --target-dir target/site-rust
	rm -rf target/site docs/gallery
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet --builder html docs target/site
	cp -r target/site-rust/doc target/site/rust

docs-test: docs  ## opens every page in a headless Chromium, which root installs on Debian where there is none
	command -v chromedriver > /dev/null || { test "$$(id -u)" = 0 && apt-get update -qq && apt-get install -qq -y --no-install-recommends chromium chromium-driver > /dev/null; } || echo "no Chromium: the site is not opened"
	$(BIN)/python -m pytest -q tests/site

$(VENV)/documented: docs/requirements.txt $(VENV)/installed
	$(BIN)/python -m pip install --quiet --requirement $<
	touch $@

$(VENV)/tested: crates/py/requirements-test.txt $(VENV)/ready
	$(BIN)/python -m pip install --quiet --requirement $<
	touch $@

# The sdist must build where there is no network: its crates' sources are vendored from its own lock file, and Cargo is told to stay offline.
package: $(VENV)/installed  ## the sdist and a wheel from it without network, the two crates as they would be published
	rm -rf target/package-check && mkdir -p target/package-check
	$(BIN)/maturin sdist --manifest-path crates/py/Cargo.toml --out target/package-check
	tar -xzf target/package-check/andoyer-*.tar.gz -C target/package-check && rm target/package-check/andoyer-*.tar.gz
	cd target/package-check/andoyer-* && mkdir .cargo && cargo vendor --quiet > .cargo/config.toml
	cd target/package-check/andoyer-* && CARGO_NET_OFFLINE=true $(abspath $(BIN))/maturin build --quiet --release --locked --offline --interpreter $(abspath $(BIN))/python --out ..
	$(PYTHON) -m venv target/package-check/venv
	target/package-check/venv/bin/python -m pip install --quiet target/package-check/andoyer-*.whl
	target/package-check/venv/bin/python -m andoyer.selftest
	cargo package --quiet -p andoyer-series -p andoyer-propagate --target-dir target/package-check/crates

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
