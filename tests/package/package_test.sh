#!/usr/bin/env bash
# package_test.sh BUILD WORK [CMAKE ARGUMENTS…]: installs the built misfit to a folder under WORK, builds the project beside this file against it,
# and looks for its effect in the program it makes.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$1 work=$2
shift 2

rm -rf "$work"
cmake --install "$build" --prefix "$work/prefix" > /dev/null
"$work/prefix/bin/misfit" effects > "$work/installed.txt"
cmake -S "$here" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" "$@" > "$work/configure.log" || { cat "$work/configure.log"; exit 1; }
cmake --build "$work/build"
"$work/build/own_misfit" effects > "$work/own.txt"

fail() { echo "FAILED: $*"; exit 1; }
grep -q strut_interference "$work/own.txt" || fail "the own program does not list its effect"
grep -q pitch_damping "$work/own.txt" || fail "the own program does not list misfit's effects"
! grep -q strut_interference "$work/installed.txt" || fail "the installed program lists an effect it cannot have"
