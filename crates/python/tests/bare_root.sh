#!/usr/bin/env bash
# Installs a wheel on a machine without compilers, and renders a picture: both within 60 seconds.
#
#     crates/python/tests/bare_root.sh target/packages/lightmesh-*.whl [PYTHON]
#
# The machine is a folder that becomes the root: the given Python with pip, libc and those libraries that a manylinux wheel may expect. It has no
# shell, no compiler, no Rust and no network; NumPy's wheel is fetched before. Linux alone; without root's rights it needs user namespaces.
set -euo pipefail

wheel=$1
python=$(command -v "${2:-python3}")
limit=60
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT

# The executable, its standard library, its folder of packages, and pip, one a line.
mapfile -t paths < <("$python" -c '
import os, pip, sys, sysconfig
packages = sysconfig.get_path("purelib", vars={"base": sys.base_prefix})
print(os.path.realpath(sys.executable), sysconfig.get_path("stdlib"), packages, os.path.dirname(pip.__file__), sep="\n")')
executable=${paths[0]} library=${paths[1]} packages=${paths[2]}

# 1. Python without the packages that are installed there.
mkdir -p "$root"{"$(dirname "$executable")","$library","$packages",/dev,/proc,/tmp,/wheels}
cp "$executable" "$root$executable"
tar -C "$library" --exclude ./site-packages --exclude ./dist-packages --exclude ./test --exclude __pycache__ -c . | tar -C "$root$library" -x
cp -r "${paths[3]}" "$root$packages"

# 2. Libraries that it needs, and those that manylinux promises: all parts of libc, and what compilers add.
linked() {
    { ldd "$executable"; find "$root$library" -name '*.so' -exec ldd {} +; } | grep -o '/[^ ]*\.so[^ ]*' | grep -v "^$root" | sed 's/:$//'
    ldconfig -p | grep -E 'lib(c|m|dl|rt|util|pthread|gcc_s|stdc\+\+)\.so' | grep -o '/.*'
}
linked | sort -u | while read -r path; do
    mkdir -p "$root$(dirname "$path")"
    cp -Ln "$path" "$root$path"
done

# 3. The wheels.
cp "$wheel" "$root/wheels"
"$python" -m pip download --quiet --disable-pip-version-check --only-binary :all: --dest "$root/wheels" numpy
if find "$root" -type f -regextype egrep -regex '.*/(cc|c\+\+|gcc|g\+\+|clang|ld|make|cargo|rustc|sh|bash)' | grep .; then
    echo 'error: the root is not bare' >&2
    exit 1
fi

cat >"$root/picture.py" <<'PICTURE'
import lightmesh

frame = lightmesh.Renderer().render(lightmesh.Scene.builtin("childpark"), size=(640, 480))
frame.save("/picture.png")
print(f"rendered {frame.rgb.shape[1]}x{frame.rgb.shape[0]} pixels, {frame.rgb.mean():.3f} on average")
PICTURE

# inside ARGUMENTS…: runs Python in the root, without a network and without variables from outside.
inside() {
    local rights=()
    [[ $(id -u) == 0 ]] || rights=(--map-root-user)
    # shellcheck disable=SC2016 # the inner shell expands them
    env -i PATH="$PATH" HOME=/tmp LANG=C.UTF-8 \
        unshare "${rights[@]}" --mount --net bash -c 'mount --rbind /dev "$1/dev" && exec chroot "$@"' - "$root" "$executable" "$@"
}

seconds() { awk -v start="$1" -v end="$(date +%s.%N)" 'BEGIN { printf "%.1f", end - start }'; }

# 4. What a user types.
start=$(date +%s.%N)
inside -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --no-index --find-links /wheels "/wheels/$(basename "$wheel")"
echo "installed after $(seconds "$start") s"
inside /picture.py
total=$(seconds "$start")
[[ $(head -c 4 "$root/picture.png" | tail -c 3) == PNG ]]
inside -m lightmesh info builtin:childpark >"$root/info"
grep -q triangles "$root/info"
echo "a picture after $total s with $("$python" --version) and $(cd "$root/wheels" && echo *)"
if awk -v total="$total" -v limit="$limit" 'BEGIN { exit total <= limit }'; then
    echo "error: that takes longer than $limit s" >&2
    exit 1
fi
