# Shortcuts; each line works without `just` as well.

# List all commands
default:
    @just --list

# Render a scene: just render SCENE [FLAGS…]
render scene="builtin:childpark" *flags="-o childpark.png":
    cargo run --release -- render {{scene}} {{flags}}

# All tests
test:
    cargo test --workspace

# Most tests, in half a minute once they are built; needs cargo-nextest
fast *filter:
    cargo nextest run --workspace --profile fast {{filter}}

# Format and lints
lint:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets -- -D warnings

# Documentation of all crates, without warnings
doc:
    RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
    cargo xtask check-docs

# The book, as target/book/index.html; needs mdbook
book:
    mdbook build book

# Licences, sources and versions of all dependencies; needs cargo-deny
deny:
    cargo deny --locked check --hide-inclusion-graph licenses bans sources
    cargo deny --locked --manifest-path fuzz/Cargo.toml --config deny.toml check --hide-inclusion-graph licenses bans sources

# Generate the layout header, the kernels' PTX and the report on them
kernels:
    cargo xtask kernels

# Generate the map of the sources, docs/map.md
map:
    cargo xtask map

# Generate the tables of docs/results and docs/method from the results they name
readme:
    cargo xtask readme

# Generate the drawings of docs/method
drawings:
    cargo xtask drawings

# Generate types and help of Python's keyword arguments from the table of settings
settings:
    cargo xtask settings

# The Python package in an environment of its own, target/python
_python:
    python3 -m venv target/python
    target/python/bin/python -m pip install --quiet --disable-pip-version-check ./crates/python

# The wheel of the Python package as released, in target/packages
wheel:
    .ci/package wheel

# What a release has for this system: wheel, Blender extension and program, in target/packages
package:
    .ci/package

# Install that wheel in a root with Python alone, and render a picture there
bare-root wheel="target/packages/*.whl":
    crates/python/tests/bare_root.sh {{wheel}}

# Build the Python package, and test it
python-test *flags: _python
    target/python/bin/python -m pip install --quiet --disable-pip-version-check --requirement .ci/python.txt
    target/python/bin/python -m pytest crates/python/tests {{flags}}

# Run the notebooks and the book's page on Python, or those that are named
notebooks *files="notebooks/*.ipynb book/src/python.md": _python
    target/python/bin/python -m pip install --quiet --disable-pip-version-check --requirement .ci/python.txt
    target/python/bin/python notebooks/run.py {{files}}

# The Blender add-on as an extension with its wheel, in target/packages
addon:
    .ci/package extension

# Test the Blender add-on in Blender as a Python module, which needs Python 3.11; the version is 4.5 or 5.0
addon-test version="4.5" wheel="target/packages/*.whl":
    python3.11 -m venv target/blender-{{version}}
    target/blender-{{version}}/bin/python -m pip install --quiet --disable-pip-version-check --requirement .ci/blender-{{version}}.txt
    target/blender-{{version}}/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall {{wheel}}
    LIGHTMESH_WHEEL=$(echo {{justfile_directory()}}/{{wheel}}) target/blender-{{version}}/bin/python -m pytest blender/tests

# Package the crates and show the order in which they are published; uploads nothing. Without --no-verify each is built from its package
publish-order *flags="--no-verify":
    cargo publish --workspace --dry-run --locked {{flags}}

# Everything a change must pass
ci:
    .ci/run
