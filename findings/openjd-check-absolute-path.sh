#!/usr/bin/env bash
# `openjd check` passes a template whose PATH parameter has an absolute default, and `openjd run` refuses the same template
#
# Expected: a template that "passes validation checks" can be run with its defaults.
#
# Happens: defaults of PATH parameters must be relative, and lie in the template's folder. That is checked only when a job is made: `check` says that
# the template passes, and `run` ends with an error unless the value is given again with -p, though it is the same one.
#
# Versions: openjd-cli 0.8.0, openjd-model 0.13.0, openjd-sessions 0.13.0, pydantic 2.14.4, PyYAML 6.0.4, Python 3.11.
#
# Why it matters: programs that write templates know absolute paths, and a pipeline that validates what they wrote by `check` finds out on the farm.
# Write paths from the template's folder on, and leave the default out for what lies elsewhere.
#
# Output seen:
#   check, absolute default:                    exit 0, passes validation checks
#   run, absolute default:                      exit 1, is an absolute path
#   run, the same path given with -p:           exit 0, /srv/scene.txt
#   run, relative default ../scene.txt:         exit 1, outside of the template directory
#   run, relative default scene.txt:            exit 0
set -euo pipefail

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check --only-binary :all: \
    openjd-cli==0.8.0 openjd-model==0.13.0 openjd-sessions==0.13.0 pydantic==2.14.4 PyYAML==6.0.4
mkdir "$dir/job"
cd "$dir/job"

template() { # the default of the parameter
    cat >job.yaml <<EOF
specificationVersion: jobtemplate-2023-09
name: show
parameterDefinitions:
  - {name: Scene, type: PATH, default: "$1"}
steps:
  - name: Show
    script: {actions: {onRun: {command: echo, args: ["{{Param.Scene}}"]}}}
EOF
}

fail() {
    echo "changed: $*" >&2
    exit 1
}

# what, the expected exit code, a text of the output, and the command of openjd
try() {
    local what=$1 code=$2 text=$3 status=0
    shift 3
    ../venv/bin/openjd "$@" >out 2>&1 || status=$?
    # Lines are wrapped at the width of a terminal.
    tr -s ' \n' ' ' <out | grep -qF "$text" || fail "$what does not say: $text"
    printf '%-43s exit %d, %s\n' "$what:" "$status" "$text"
    [ "$status" = "$code" ] || fail "$what exits with $status"
}

template /srv/scene.txt
try 'check, absolute default' 0 'passes validation checks' check job.yaml
try 'run, absolute default' 1 'is an absolute path' run job.yaml
try 'run, the same path given with -p' 0 '/srv/scene.txt' run job.yaml -p Scene=/srv/scene.txt
template ../scene.txt
try 'run, relative default ../scene.txt' 1 'outside of the template directory' run job.yaml
template scene.txt
try 'run, relative default scene.txt' 0 'scene.txt' run job.yaml
