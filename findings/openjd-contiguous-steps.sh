#!/usr/bin/env bash
# With `rangeConstraint: CONTIGUOUS`, every second frame makes a task of its own, whatever `defaultTaskCount` says
#
# Expected: the frames 1-19:2 in chunks of 5 make two tasks, or the template is refused.
#
# Happens: a chunk may only hold numbers without a gap, so that a range with a step makes chunks of one, `1-1`, `3-3`, …: ten tasks. NONCONTIGUOUS makes
# two, `1-9:2` and `11-19:2`, and of a range without steps the same chunks as CONTIGUOUS. Chunks are also evened out: 12 frames by 5 are 4, 4, 4.
#
# Versions: openjd-cli 0.8.0, openjd-model 0.13.0, openjd-sessions 0.13.0, pydantic 2.14.4, PyYAML 6.0.4, Python 3.11.
#
# Why it matters: the range is often a parameter of the job, and "every tenth frame first" is how films are proofed. Then each task loads its scene anew for
# one frame, which chunks were to avoid. A renderer that reads steps should ask for NONCONTIGUOUS.
#
# Output seen:
#   CONTIGUOUS 1-12:        1-4 5-8 9-12
#   CONTIGUOUS 1-19:2:      1-1 3-3 5-5 7-7 9-9 11-11 13-13 15-15 17-17 19-19
#   NONCONTIGUOUS 1-12:     1-4 5-8 9-12
#   NONCONTIGUOUS 1-19:2:   1-9:2 11-19:2
set -euo pipefail

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: \
    openjd-cli==0.8.0 openjd-model==0.13.0 openjd-sessions==0.13.0 pydantic==2.14.4 PyYAML==6.0.4
cd "$dir"

chunks() { # constraint, range, what is expected
    cat >job.yaml <<EOF
specificationVersion: jobtemplate-2023-09
extensions: [TASK_CHUNKING]
name: chunks
parameterDefinitions:
  - {name: Frames, type: STRING}
steps:
  - name: Show
    parameterSpace:
      taskParameterDefinitions:
        - {name: Frame, type: "CHUNK[INT]", range: "{{Param.Frames}}", chunks: {defaultTaskCount: 5, rangeConstraint: $1}}
    script: {actions: {onRun: {command: echo, args: ["chunk {{Task.Param.Frame}}"]}}}
EOF
    local seen
    seen=$(venv/bin/openjd run job.yaml -p "Frames=$2" | sed -n 's/^[0-9:.]*\tchunk //p' | paste -sd ' ')
    printf '%-23s %s\n' "$1 $2:" "$seen"
    [ "$seen" = "$3" ] || { echo "changed: expected $3" >&2; exit 1; }
}

chunks CONTIGUOUS 1-12 '1-4 5-8 9-12'
chunks CONTIGUOUS 1-19:2 '1-1 3-3 5-5 7-7 9-9 11-11 13-13 15-15 17-17 19-19'
chunks NONCONTIGUOUS 1-12 '1-4 5-8 9-12'
chunks NONCONTIGUOUS 1-19:2 '1-9:2 11-19:2'
