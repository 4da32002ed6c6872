# Shortcuts; each line works without `just` as well.

# List what there is
default:
    @just --list

# Render a scene: just render SCENE [FLAGS…]
render scene="builtin:childpark" *flags="-o childpark.png":
    cargo run --release -- render {{scene}} {{flags}}

# All tests
test:
    cargo test --workspace

# Format and lints
lint:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets -- -D warnings

# Documentation of all crates, without warnings
doc:
    RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps
    cargo xtask check-docs

# Licences of all dependencies
licences:
    cargo xtask licences

# The layout header, the kernels' PTX and the report about them
kernels:
    cargo xtask kernels

# Tables of the README from the results that they name
readme:
    cargo xtask readme

# Everything a change must pass
ci:
    .ci/run
