# Everything runs from a clean checkout with cargo and Python 3.11 or later; .venv and target are made here.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# Python compiles a module when it is first imported. To compile every installed module takes pip 30 seconds.
INSTALL = $(BIN)/python -m pip install --quiet --no-compile
export PYTHONDONTWRITEBYTECODE :=
WHEELS := target/wheels
RIVALS := target/rivals-venv
COPY_DEPENDENCIES := org.apache.maven.plugins:maven-dependency-plugin:3.8.1:copy-dependencies

.PHONY: demo test test-rust test-clippy test-wheel test-text test-python test-site test-package check-python lint lint-python lint-rust bench figures report sweep scenes light-curves verdicts pulls libration-cost libration-reach evolution-times members nature bounds stress stress-short gate gate-write memcheck fuzz supply deny msrv wasm explore minimal-versions parallel rivals rivals-normal-form rivals-products rivals-propagation rivals-gradient rivals-libration rivals-batch rivals-driven rivals-partials rivals-ephemeris rivals-messages gravity docs docs-test package release release-check wheel clean kernels playground playground-test

demo: $(VENV)/installed  ## build and install the wheel, run the scenes, print the table, draw the pictures
	$(BIN)/python examples/demo.py

# Property tests draw the same cases in each run of a target here, and leave no file behind.
export PROPTEST_RNG_SEED ?= 1
export PROPTEST_DISABLE_FAILURE_PERSISTENCE := 1

# The compiler locks a profile's folder, so the steps of the test profile stand in one row, those of the wheel in another, and both run at the same time. The site is built
# from the wheel in the first row, which ends earlier.
test:  ## everything that CI runs, in two rows at the same time; at the end the times of the steps
	rm -f target/steps.csv
	$(MAKE) --no-print-directory -j2 --output-sync=target test-package
	$(PYTHON) tests/steps.py

STEP = $(PYTHON) tests/steps.py
test-rust:
	$(STEP) rust cargo test --workspace --exclude andoyer-py --quiet

test-clippy: test-rust
	$(STEP) clippy $(MAKE) --no-print-directory lint-rust

# What the site needs is installed here, so that nothing is installed while tests run.
test-wheel:
	$(STEP) wheel $(MAKE) --no-print-directory $(VENV)/installed $(VENV)/tested $(VENV)/documented

test-text: test-wheel
	$(STEP) text $(MAKE) --no-print-directory lint-python supply

test-python: test-text
	$(STEP) python $(MAKE) --no-print-directory check-python

# The documentation of the crates is written to the same folder by clippy's step.
test-site: test-clippy test-wheel
	$(STEP) site $(MAKE) --no-print-directory docs-test

test-package: test-python test-site
	$(STEP) stress $(MAKE) --no-print-directory stress-short
	$(STEP) gate $(MAKE) --no-print-directory gate

check-python: $(VENV)/installed $(VENV)/tested  ## the tests of the wheel, and the examples of the pages
	$(BIN)/python tests/reference/torque_free.py tests/data/torque_free.json
	$(BIN)/python examples/scenes/make_scenes.py --check
	$(BIN)/python tests/stress/bounds.py --scenes 120
	$(BIN)/python -m pytest -q crates/py/tests
	mkdir -p out
	$(BIN)/python -m pytest -q --doctest-glob='*.md' --ignore=docs/gallery README.md docs

lint: lint-python lint-rust  ## formatting, clippy, ruff, documentation, the imports between the files of each crate, and type names

lint-python: $(VENV)/ready
	$(BIN)/ruff check --config tests/ruff.toml --quiet .
	$(BIN)/ruff format --config tests/ruff.toml --check --quiet .
	$(PYTHON) tests/layers.py
	$(PYTHON) tests/layers.py --planted
	$(PYTHON) tests/names.py
	$(PYTHON) tests/names.py --planted
	$(PYTHON) benches/figures.py --check
	$(PYTHON) tests/release.py
	$(PYTHON) tests/release.py --planted

PROGRAMS := andoyer-benches/programs,andoyer-tests/programs
lint-rust:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --features $(PROGRAMS) --quiet -- -D warnings
	cargo clippy -p andoyer-propagate --no-default-features --quiet -- -D warnings
	cargo clippy -p andoyer-propagate --no-default-features --features torques,rayon --quiet -- -D warnings
	cargo clippy -p andoyer-propagate --no-default-features --features scene-files,code --quiet -- -D warnings
	cargo clippy -p andoyer-series --no-default-features --quiet -- -D warnings
	cargo clippy -p andoyer-series --no-default-features --features serde,code --quiet -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --workspace --no-deps --document-private-items --quiet

bench: $(VENV)/installed  ## criterion by order, then run time against error: docs/data/bench.csv, docs/data/work-precision.csv; a quarter of an hour
	start=$$(date +%s) && cargo bench -p andoyer-benches && $(BIN)/python benches/collect.py --since $$start
	$(BIN)/python benches/work_precision.py

figures: $(VENV)/installed  ## every file of docs/data anew, in one run on a clean commit, with where each comes from; more than an hour on two idle cores
	$(BIN)/python benches/figures.py
	$(MAKE) --no-print-directory report

report: $(VENV)/ready  ## the figures of docs/speed.md with their picture, and the tables of the README, from docs/data, which must be of one run
	$(BIN)/python benches/report.py
	$(PYTHON) tests/release.py --write

scenes: $(VENV)/installed  ## the example scenes and an ensemble: docs/data/scenes.csv and ensemble.csv
	$(BIN)/python examples/demo.py --record

light-curves: $(VENV)/installed  ## light curves with known answers: docs/data/light-curves.csv; some minutes
	$(BIN)/python benches/light_curves.py

verdicts: $(VENV)/installed  ## how often verdicts on simulated light curves are right, by model of the body: docs/data/verdicts.csv; three quarters of an hour
	rm -f docs/data/verdicts.csv
	for model in ellipsoid facets; do \
	  $(BIN)/python benches/verdicts.py --seed 300 --count 30 --starts 1000 --model $$model --out docs/data/verdicts.csv || exit 1; \
	done
	$(BIN)/python benches/verdicts.py --out docs/data/verdicts.csv --picture docs/verdicts.png

libration-reach: $(VENV)/installed  ## the share of random locked scenes that are served: docs/data/libration-reach.csv and its picture; some minutes
	cargo build --release --quiet --package andoyer-tests --features programs --bin libration
	target/release/libration reach 300 1 > docs/data/libration-reach.csv
	$(BIN)/python benches/libration_reach.py

pulls: $(VENV)/installed  ## pulls of 200 fits of light curves in magnitudes: docs/data/pulls.csv; a quarter of an hour
	$(BIN)/python tests/stress/pulls.py --out docs/data/pulls.csv

evolution-times: $(VENV)/installed  ## averages over years beside integrations: docs/data/evolution-times.csv; half a minute
	$(BIN)/python benches/evolution_times.py

members: $(VENV)/installed $(VENV)/tested  ## seconds and memory of large ensembles, by kind: docs/data/members.csv; some minutes
	$(BIN)/python benches/members.py

libration-cost: $(VENV)/installed  ## librations by order and eccentricity: docs/data/libration-cost.csv and its picture; some minutes
	$(BIN)/python benches/libration_cost.py

# With the features of the wheel, so that its libraries are compiled once.
kernels:
	cargo build --release --locked --quiet -p andoyer-py -p andoyer-benches --features andoyer-benches/programs --bin kernels

gate: kernels  ## instruction counts of ten kernels against benches/instructions.json, where there is valgrind
	$(PYTHON) benches/gate.py target/release/kernels

gate-write: kernels  ## takes the counts of now as those to keep
	$(PYTHON) benches/gate.py target/release/kernels --write

memcheck: kernels  ## valgrind over the kernels, whose SIMD is pulp's (there is no unsafe code here)
	for kernel in normalize numeric solve-closed solve-series evaluate integrate member derivatives libration periodic; do valgrind --quiet --error-exitcode=1 target/release/kernels $$kernel 1 || exit 1; done

stress: $(VENV)/installed  ## 240,000 random scenes of every regime against 40 digits: docs/data/stress.csv, docs/accuracy.md; minutes
	$(BIN)/python tests/stress/run.py --write

stress-short: $(VENV)/installed  ## the same with 16,000 scenes, a minute
	$(BIN)/python tests/stress/run.py --short

FUZZED := series_json scene_toml expression scene_numbers kernel
FUZZ_SECONDS ?= 60
fuzz:  ## each fuzz target for a minute; needs a nightly compiler, and cargo-fuzz, which is installed if it is not there
	command -v cargo-fuzz >/dev/null || cargo install --locked --quiet cargo-fuzz
	for target in $(FUZZED); do \
	  mkdir -p target/fuzz/corpus/$$target && \
	  cargo +nightly fuzz run --fuzz-dir tests/fuzz --target-dir target/fuzz --release --sanitizer none $$target target/fuzz/corpus/$$target tests/fuzz/corpus/$$target -- -max_total_time=$(FUZZ_SECONDS) -timeout=20 -rss_limit_mb=2048 -max_len=4096 || exit 1; \
	done

supply:  ## licences, bans and sources of every locked dependency, by cargo alone
	$(PYTHON) tests/supply.py

EXPLORED ?= 2000
explore:  ## property tests with new cases, EXPLORED of them where a test sets no number; SEED repeats a run. What it finds becomes a case of a test
	seed=$${SEED:-$$(date +%s)} && echo "SEED=$$seed" && \
	  PROPTEST_RNG_SEED=$$seed PROPTEST_CASES=$(EXPLORED) cargo test --release --quiet -p andoyer-double -p andoyer-series && \
	  PROPTEST_RNG_SEED=$$seed cargo test --release --quiet -p andoyer-tests -- invariants observed

deny:  ## the same rules by cargo-deny, which is installed if it is not there
	command -v cargo-deny >/dev/null || cargo install --locked --quiet cargo-deny
	cargo deny --offline --config tests/deny.toml check licenses bans sources

msrv:  ## the oldest compiler that Cargo.toml promises
	cargo +$$(sed -n 's/^rust-version = "\(.*\)"/\1.0/p' Cargo.toml) check --workspace --all-targets --locked --quiet --target-dir target/msrv

wasm:  ## the crates for WebAssembly, without a warning; rustup adds the target if it is not there
	rustup target add wasm32-unknown-unknown
	RUSTFLAGS='-D warnings' cargo check --locked --quiet --target wasm32-unknown-unknown -p andoyer-double -p andoyer-kernels -p andoyer-series -p andoyer-propagate --target-dir target/wasm

MINIMAL := target/minimal-versions
minimal-versions:  ## the oldest versions of the direct dependencies that Cargo.toml promises, in a copy
	rm -rf $(MINIMAL)/source && mkdir -p $(MINIMAL)/source
	cp -r Cargo.toml README.md crates tests benches $(MINIMAL)/source
	cd $(MINIMAL)/source && RUSTC_BOOTSTRAP=1 cargo update --quiet -Z direct-minimal-versions
	cargo check --workspace --locked --quiet --manifest-path $(MINIMAL)/source/Cargo.toml --target-dir $(MINIMAL)/target

PARALLEL := body_and_scene motion ensemble orbit expressions normal_form normalize
parallel: $(VENV)/installed  ## the wheel's tests of objects, each on eight threads at once; those of signals, processes and files are not for threads
	$(INSTALL) 'pytest-run-parallel>=0.6'
	$(BIN)/python -m pytest -q --parallel-threads=8 $(PARALLEL:%=crates/py/tests/test_%.py)

sweep: $(VENV)/installed  ## series against closed form by order, σ/σ_sep and β: docs/data/sweep.csv, picture and table of its page; a minute
	$(BIN)/python benches/sweep.py

gravity: $(VENV)/installed  ## what each level of the gravity-gradient theory leaves, against integrations: docs/data/gravity-*.csv and their picture; some minutes
	cargo build --release --quiet --package andoyer-tests --features programs --bin gradient
	target/release/gradient cases > docs/data/gravity-cases.csv
	target/release/gradient levels > docs/data/gravity-levels.csv
	target/release/gradient bounds 150 1 > docs/data/gravity-bounds.csv
	target/release/gradient climb 3 150 2025 > docs/data/gravity-climb.csv
	target/release/gradient table 40 1 > docs/data/gravity-table.csv
	$(BIN)/python benches/averaged.py --scenes 30 --seed 2 --output docs/data/averaged-bodies.csv
	$(BIN)/python benches/long_spans.py --output docs/data/gravity-spans.csv
	$(BIN)/python benches/gravity.py

nature: $(VENV)/kernels  ## a rigid Earth and Moon at DE440 positions beside REN-2000 and DE421: docs/data/nature-*.csv and their pictures; a quarter of an hour
	$(BIN)/python tests/nature/moon.py
	$(BIN)/python tests/nature/moon_terms.py
	for language in c:c rust:rs python:py javascript:js; do \
	  cargo run --release --locked --quiet -p andoyer-series --example moon_table -- $${language%:*} < docs/data/nature-moon-terms.csv > docs/data/moon_orientation.$${language#*:} || exit 1; \
	done
	$(BIN)/python tests/nature/moon_rivals.py
	$(BIN)/python tests/nature/earth.py

bounds: $(VENV)/installed  ## errors of 3000 random scenes, 1000 tensors and 1000 integrated members against their bounds, of averaged motions and passages of resonances against their estimates, and members against their scenes, derivatives by torques against 80 bits; a quarter of an hour
	$(BIN)/python tests/stress/bounds.py
	$(BIN)/python tests/stress/tensors.py
	$(BIN)/python tests/stress/members.py
	$(BIN)/python tests/stress/member_bounds.py --members 1000
	$(BIN)/python tests/stress/evolutions.py
	$(BIN)/python tests/stress/passages.py
	$(BIN)/python tests/stress/torque_partials.py

rivals: rivals-normal-form rivals-products rivals-propagation rivals-gradient rivals-integration rivals-batch rivals-driven rivals-partials rivals-ephemeris rivals-messages  ## the tables of ratios, in out/ too

rivals-normal-form: $(RIVALS)/normal-form $(RIVALS)/installed  ## the normal form against python-flint, SymPy and SymEngine
	$(RIVALS)/bin/python benches/rivals/normal_form.py --data docs/data/rivals-normal-form.csv

rivals-products: $(RIVALS)/normal-form  ## products of polynomials against python-flint, Symbolica and SymEngine
	cargo build --release --locked --quiet -p andoyer-benches --features programs --bin products
	$(RIVALS)/bin/python benches/rivals/products.py --engine target/release/products --rivals flint flint-rational symbolica --data docs/data/rivals-products.csv

rivals-propagation: $(RIVALS)/propagation $(RIVALS)/installed $(RIVALS)/orekit/ready  ## propagation against heyoka, SciPy, ode_solvers and, where there is Maven, Orekit
	RUSTFLAGS='-C target-cpu=native' cargo build --release --locked --quiet --manifest-path benches/rivals/ode_solvers/Cargo.toml --target-dir $(RIVALS)/ode_solvers
	$(RIVALS)/bin/python benches/rivals/propagation.py --data docs/data/rivals-propagation.csv --ode-solvers $(RIVALS)/ode_solvers/release/ode-solvers-rival --orekit $(RIVALS)/orekit
	$(RIVALS)/bin/python benches/rivals/coming_from.py

rivals-gradient: $(RIVALS)/propagation $(RIVALS)/installed  ## the gravity gradient against heyoka
	$(RIVALS)/bin/python benches/rivals/gradient.py --output docs/data/rivals-gradient.csv

rivals-integration: $(RIVALS)/propagation $(RIVALS)/installed  ## the integrated method against heyoka, in nine regimes
	$(RIVALS)/bin/python benches/rivals/integration.py --output docs/data/rivals-integration.csv

rivals-batch: $(RIVALS)/propagation $(RIVALS)/installed  ## ensembles of integrated members against heyoka's batch mode, in seven regimes
	$(RIVALS)/bin/python benches/rivals/integration.py --batch --output docs/data/rivals-batch.csv

rivals-libration: $(RIVALS)/propagation $(RIVALS)/installed  ## librations against the integration and heyoka: docs/data/libration-rivals.csv; a quarter of an hour
	$(RIVALS)/bin/python benches/rivals/libration.py --output docs/data/libration-rivals.csv

rivals-driven: $(RIVALS)/propagation $(RIVALS)/installed  ## normal forms with a driven phase against heyoka
	$(RIVALS)/bin/python benches/rivals/driven.py

rivals-partials: $(RIVALS)/propagation $(RIVALS)/installed  ## derivatives against heyoka's variational equations
	$(RIVALS)/bin/python benches/rivals/partials.py --output docs/data/rivals-partials.csv

rivals-ephemeris: $(VENV)/kernels $(VENV)/tested  ## states of DE440 against SpiceyPy and jplephem
	cargo build --release --locked --quiet -p andoyer-kernels --example states
	$(BIN)/python benches/rivals/ephemeris.py --output docs/data/rivals-ephemeris.csv

rivals-messages: $(RIVALS)/installed $(RIVALS)/orekit/ready  ## attitude ephemeris messages as we write them, read by Orekit; EXAMPLES=FOLDER: other messages, read by both
	$(RIVALS)/bin/python -m pip install --quiet astropy
	$(RIVALS)/bin/python benches/rivals/attitude_messages.py --orekit $(RIVALS)/orekit $(if $(EXAMPLES),--examples $(EXAMPLES))

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

docs: $(VENV)/documented $(VENV)/tested  ## the site in target/site, the Rust documentation in it; warnings are errors, and the network is not used
	$(BIN)/python docs/_ext/rustdoc.py --check
	rm -rf target/doc
	RUSTDOCFLAGS='-D warnings' cargo doc --no-deps --quiet -p andoyer-double -p andoyer-kernels -p andoyer-series -p andoyer-propagate
	rm -rf target/site docs/gallery
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet --builder html docs target/site
	cp -r target/doc target/site/rust
	$(BIN)/python examples/pages.py target/site/pages

docs-test: docs  ## the pages as files, and in a headless Chromium of this machine (Debian: apt-get install chromium)
	$(BIN)/python -m pytest -q tests/site

playground:  ## the playground of the site in target/playground, which `make docs` then copies; rustup adds WebAssembly, cargo the command wasm-bindgen, if they are not there
	$(PYTHON) crates/playground/build.py

playground-test: playground $(VENV)/documented $(VENV)/tested  ## the playground in a headless Chromium, against the installed library: presets, flips, bits; sizes and frames are printed
	$(BIN)/python -m pytest -q -s tests/site/test_playground.py

$(VENV)/documented: docs/requirements.txt $(VENV)/installed
	$(INSTALL) --requirement $<
	touch $@

# Of the packages only their files are used: an ephemeris of 120 MB, and the orientation of the Moon.
$(VENV)/kernels: tests/nature/requirements.txt $(VENV)/installed
	$(INSTALL) --no-deps --requirement $<
	touch $@

$(VENV)/tested: crates/py/requirements-test.txt $(VENV)/ready
	$(INSTALL) --requirement $<
	touch $@

# The sdist must build where there is no network: its crates' sources are vendored from its own lock file, and Cargo gets an empty home and stays offline.
# The crates are packaged in a new folder each time, because Cargo keeps the sources of a local registry under its path and would verify with those of the last run.
package: $(VENV)/installed  ## the sdist and a wheel from it without network, the crates as they would be published
	rm -rf target/package-check && mkdir -p target/package-check
	$(BIN)/maturin sdist --manifest-path crates/py/Cargo.toml --out target/package-check
	tar -xzf target/package-check/andoyer-*.tar.gz -C target/package-check && rm target/package-check/andoyer-*.tar.gz
	cd target/package-check/andoyer-* && mkdir .cargo && cargo vendor > .cargo/config.toml 2> ../vendor.log || { cat ../vendor.log; exit 1; }
	cd target/package-check/andoyer-* && CARGO_HOME=$(abspath target/package-check/cargo) CARGO_NET_OFFLINE=true $(abspath $(BIN))/maturin build --quiet --release --locked --offline --interpreter $(abspath $(BIN))/python --out ..
	for text in MIT APACHE; do \
		for crate in double kernels series propagate py; do cmp LICENSE-$$text crates/$$crate/LICENSE-$$text || exit 1; done; \
		unzip -p target/package-check/andoyer-*.whl '*.dist-info/licenses/LICENSE-'$$text | cmp - LICENSE-$$text || exit 1; \
	done
	$(PYTHON) -m venv target/package-check/venv
	target/package-check/venv/bin/python -m pip install --quiet target/package-check/andoyer-*.whl
	target/package-check/venv/bin/python -m andoyer.selftest
	cargo package --quiet -p andoyer-double -p andoyer-kernels -p andoyer-series -p andoyer-propagate --target-dir $$(mktemp -d -p target/package-check crates.XXXXXX)

release:  ## the notes of changes/ as the section of the version that Cargo.toml has, and the files that follow from it
	$(PYTHON) tests/release.py --release

release-check: package  ## versions, addresses and licences agree; public Rust names against the last tag, where there is one and cargo-semver-checks
	$(PYTHON) tests/release.py
	$(PYTHON) tests/release.py --semver
	$(PYTHON) benches/figures.py --check --fresh

wheel: $(VENV)/installed

# The wheel is rebuilt when any source of it is newer than the installation: tests and the caches of tools are none.
SOURCES := Cargo.toml Cargo.lock README.md $(shell find crates \( -name '.*' -o -name tests -o -name playground \) -prune -o \( -name '*.rs' -o -name '*.py' -o -name '*.pyi' -o -name '*.toml' -o -name '*.md' \) -print)
$(VENV)/installed: $(VENV)/ready $(SOURCES)
	rm -rf $(WHEELS)
	$(BIN)/maturin build --release --locked --quiet --manifest-path crates/py/Cargo.toml --interpreter $(BIN)/python --out $(WHEELS)
	$(INSTALL) --force-reinstall --no-deps $(WHEELS)/andoyer-*.whl
	touch $@

$(VENV)/ready: crates/py/requirements.txt
	$(PYTHON) -m venv $(VENV)
	$(INSTALL) --requirement crates/py/requirements.txt
	touch $@

clean:
	rm -rf target $(VENV) out
