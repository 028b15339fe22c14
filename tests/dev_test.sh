#!/usr/bin/env bash
# What ./dev install does on machines with and without the packages, with apt-get, dpkg-query and sudo replaced by stubs that note their calls;
# which files the checks of format and clang-tidy get. The folder has a character that means something in a regular expression.
set -u
source_dir=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d -t 'dev+XXXXXX')
trap 'rm -rf "$work"' EXIT
failures=0

# machine UID SUDO MISSING…: a PATH on which the named packages are missing, for a user with the given id, with ("yes") or without sudo.
machine() {
  local uid=$1 sudo=$2
  shift 2
  rm -rf "$work/repo" "$work/bin" "$work/calls"
  mkdir -p "$work/repo" "$work/bin"
  cp "$source_dir/dev" "$source_dir/packages.txt" "$work/repo/"
  sed -i "s/EUID != 0/$uid != 0/" "$work/repo/dev"
  touch "$work/calls"
  stub dpkg-query "case \" $* \" in *\" \${@: -1} \"*) exit 1 ;; *) echo installed ;; esac"
  stub apt-get "echo \"apt-get \$*\" >> '$work/calls'"
  stub sudo "[[ $sudo == yes ]] || exit 1; while [[ \$1 == -n || \$1 == *=* ]]; do shift; done; exec \"\$@\""
}

stub() { printf '#!/bin/bash\n%s\n' "$2" > "$work/bin/$1" && chmod +x "$work/bin/$1"; }

dev() {
  output=$(PATH="$work/bin:$PATH" "$work/repo/dev" "$@" 2>&1 < /dev/null)
  status=$?
}

expect() {  # WORDS GOT WANTED
  [[ "$2" == "$3" ]] && return
  printf 'FAILED: %s\n  got:    %s\n  wanted: %s\n' "$1" "$2" "$3"
  failures=$((failures + 1))
}

installs() { grep -o 'apt-get install.*' "$work/calls" | sed 's/.*--no-install-recommends //'; }

machine 0 no
dev install
expect "all there: status" "$status" 0
expect "all there: no call of apt-get" "$(cat "$work/calls")" ""

machine 0 no ccache libceres-dev
dev install
expect "missing, root: status" "$status" 0
expect "missing, root: one update, one install" "$(wc -l < "$work/calls")" 2
expect "missing, root: update comes first" "$(head -n 1 "$work/calls" | cut -d ' ' -f 2)" update
expect "missing, root: exactly the missing packages" "$(installs)" "ccache libceres-dev"

machine 0 no
stub dpkg-query "[[ \${@: -1} == ccache ]] && echo not-installed || echo installed"
dev install
expect "removed earlier, known to dpkg: installed again" "$(installs)" "ccache"

machine 1000 yes gnuplot-nox
dev install
expect "missing, sudo: status" "$status" 0
expect "missing, sudo: exactly the missing package" "$(installs)" "gnuplot-nox"

machine 1000 no ccache libceres-dev
dev install
expect "missing, neither root nor sudo: status" "$status" 2
expect "missing, neither root nor sudo: no call of apt-get" "$(cat "$work/calls")" ""
expect "missing, neither root nor sudo: the line to type" "$(grep -o 'apt-get install.*' <<< "$output")" \
  "apt-get install --no-install-recommends ccache libceres-dev"

machine 1000 no ccache
dev demo
expect "demo stops when packages cannot be installed" "$status" 2

machine 0 no clang-tidy-16
dev install
expect "a package for ./dev check alone is not asked for by others" "$(cat "$work/calls")" ""

machine 0 no
stub apt-get "exit 100"
stub dpkg-query "exit 1"
dev install
expect "apt-get fails: so does dev" "$status" 100

machine 0 no
dev tset
expect "unknown verb: status" "$status" 2
expect "unknown verb: named" "$(grep -c 'no verb "tset"' <<< "$output")" 1
dev
expect "no verb: help" "$status $(grep -c './dev test' <<< "$output")" "0 1"

# touched FILE…: of nothing, in the repository.
touched() { for file in "$@"; do mkdir -p "$(dirname "$work/repo/$file")" && touch "$work/repo/$file"; done; }

machine 0 no
touched lib/a.cpp apps/b.h build/c.cpp .hidden/d.cpp
stub git "echo 'fatal: not a git repository' >&2; exit 128"
stub clang-format-16 "printf '%s\n' \"\$@\" >> '$work/calls'"
stub cmake "exit 1"
dev test
expect "without git: the format is checked all the same" "$(grep -c 'format: done' <<< "$output")" 1
expect "without git: of all files but what is built" "$(grep '\.[a-z]*$' "$work/calls" | xargs)" "apps/b.h lib/a.cpp"
stub clang-format-16 "echo 'lib/a.cpp:3:4: error: code should be clang-formatted' >&2; exit 1"
dev test
expect "without git: what is not formatted is named" "$status $(grep -cx lib/a.cpp <<< "$output")" "1 1"

# compiled FOLDER: lib/a.cpp of it, as CMake writes it for clang-tidy.
compiled() {
  mkdir -p "$work/repo/build/tidy"
  printf '[{\n  "directory": "/",\n  "command": "/usr/bin/c++ -DX=1 -o a.o -c a.cpp",\n  "file": "%s/lib/a.cpp"\n}]\n' "$1" \
    > "$work/repo/build/tidy/compile_commands.json"
}
machine 0 no
touched lib/a.cpp .clang-tidy
stub git "echo lib/a.cpp"
stub cmake "exit 0"
stub clang++-16 "exit 0"
stub clang-tidy-16 "echo tidied >> '$work/calls'"
compiled "$work/repo"
dev tidy
expect "tidy: checks what is compiled, whatever the folder is called" "$status $(cat "$work/calls")" "0 tidied"
compiled /elsewhere
dev tidy
expect "tidy: fails where nothing is compiled" "$status $(grep -c 'names no file of' <<< "$output")" "1 1"

((failures == 0)) && echo "dev: as expected"
exit $((failures > 0))
