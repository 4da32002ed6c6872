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

# Generate the tables of docs/results and METHOD from the results they name
readme:
    cargo xtask readme

# Generate the drawings of METHOD
drawings:
    cargo xtask drawings

# Everything a change must pass
ci:
    .ci/run
