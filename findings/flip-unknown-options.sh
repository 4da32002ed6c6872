#!/usr/bin/env bash
# The command `flip` ignores options that it does not know, and `--ppd` is such an option
#
# Expected: `-ppd` is listed in the help, so `--ppd 10`, or `--pixels-per-degrees 10` with a typing error, either works or is refused.
#
# Happens: the options' short names take one dash (`-ppd`), the long ones two (`--pixels-per-degree`). Anything else is skipped together with its
# value: the command prints no warning, exits with 0, and gives the errors of the default.
#
# Versions: flip-evaluator 1.7, numpy 2.4.6, Python 3.11.
#
# Why it matters: a script that sets the distance of the viewer, or the HDR exposures, by a mistyped option reports plausible numbers for other
# conditions. Here the mean error is about half of the one asked for. Compare the printed "Pixels per degree" with the number passed.
#
# Output seen:
#   (none)                    exit 0, Pixels per degree: 67, Mean: 0.469301
#   -ppd 10                   exit 0, Pixels per degree: 10, Mean: 0.894803
#   --pixels-per-degree 10    exit 0, Pixels per degree: 10, Mean: 0.894803
#   --ppd 10                  exit 0, Pixels per degree: 67, Mean: 0.469301
#   --pixels-per-degrees 10   exit 0, Pixels per degree: 67, Mean: 0.469301
#   --no-such-option          exit 0, Pixels per degree: 67, Mean: 0.469301
#   messages about unknown options: none
set -euo pipefail

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: flip-evaluator==1.7 numpy==2.4.6
cd "$dir"

# Two pictures of 64 x 64 pixels.
venv/bin/python - <<'EOF'
import struct
import zlib


def write_png(path, colour):
    rows = b"".join(b"\0" + bytes(c % 256 for x in range(64) for c in colour(x, y)) for y in range(64))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 64, 64, 8, 2, 0, 0, 0))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


write_png("reference.png", lambda x, y: (x * 37 + y * 11, x * 5 + y * 91, x * 59 + y * 17))
write_png("test.png", lambda x, y: (x * 37 + y * 11 + 60, x * 7 + y * 91, x * 59 + y * 23))
EOF

fail() {
    echo "changed: $*" >&2
    exit 1
}

: >messages
run() { # options of flip; sets `degree` and `mean`
    local status=0
    venv/bin/flip -r reference.png -t test.png "$@" >out 2>&1 || status=$?
    degree=$(sed -n 's/^ *Pixels per degree: //p' out)
    mean=$(sed -n 's/^ *Mean: //p' out)
    grep -iE 'unknown|unrecogni|invalid|ignor|warn|unexpected|no such|error:' out >>messages || true
    printf '%-25s exit %d, Pixels per degree: %s, Mean: %s\n' "${*:-(none)}" "$status" "$degree" "$mean"
    [ "$status" = 0 ] || fail "flip $* exits with $status"
}

run
default="$degree $mean"
run -ppd 10
asked="$degree $mean"
[ "$degree" = 10 ] && [ "$asked" != "$default" ] || fail "-ppd has no effect"
run --pixels-per-degree 10
[ "$degree $mean" = "$asked" ] || fail "--pixels-per-degree is not -ppd"
for options in '--ppd 10' '--pixels-per-degrees 10' --no-such-option; do
    # shellcheck disable=SC2086 # an option and its value
    run $options
    [ "$degree $mean" = "$default" ] || fail "flip $options has an effect"
done
[ ! -s messages ] || fail "flip mentions the option: $(head -n 1 messages)"
echo "messages about unknown options: none"
