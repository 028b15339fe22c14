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
"$work/build/own_misfit" simulate "$here/study.toml" --out "$work/out" --quiet

fail() { echo "FAILED: $*"; exit 1; }
grep -q strut_interference "$work/own.txt" || fail "the own program does not list its effect"
grep -q pitch_damping "$work/own.txt" || fail "the own program does not list misfit's effects"
! grep -q strut_interference "$work/installed.txt" || fail "the installed program lists an effect it cannot have"
# The study says why: 0.5 rad after 1 s.
awk -F, 'END { exit !($1 == 1 && ($2 - 28.6478898)^2 < 1e-6) }' "$work/out/simulation.csv" ||
  fail "the motion with the own effect ends with $(tail -n 1 "$work/out/simulation.csv"), not with t = 1 s, eta = 28.6479 deg"

# The program on misfit/misfit.h finds the friction in the first minute of the flight, and prints nothing but what it means to.
cp -r "$here/../../configs/swivel_friction" "$work/swivel"
rm -rf "$work/swivel/out"
sed -i 1801q "$work/swivel/track.csv"
"$work/build/identify" "$work/swivel/study.toml" "$work/identified" C_m > "$work/identify.txt" 2> "$work/identify.err" || fail "identify: $(cat "$work/identify.err")"
[ ! -s "$work/identify.err" ] || fail "identify prints: $(cat "$work/identify.err")"
grep -q "^added coulomb_friction" "$work/identify.txt" || fail "identify says: $(cat "$work/identify.txt")"
[ "$(grep -c ' ± ' "$work/identify.txt")" -ge 20 ] || fail "identify prints no curve: $(cat "$work/identify.txt")"
[ -s "$work/identified/rungs/01_coulomb_friction/out/fit/filter_error/curves.csv" ] || fail "identify leaves no fit of the rung"

# Both programs, the installed and the own, find the video module where it was installed.
cp -r "$here/../../configs/mpf_f111" "$work/video"
rm -rf "$work/video/out"
cp "$here/../apps/data/gaps.mkv" "$work/video/flight.mkv"
for program in "$work/prefix/bin/misfit" "$work/build/own_misfit"; do
  (cd / && env -u LD_LIBRARY_PATH "$program" track "$work/video/study.toml" --out "$work/tracked" > "$work/track.txt" 2>&1) || fail "$program track: $(cat "$work/track.txt")"
  grep -q "of 180 samples ok" "$work/track.txt" || fail "$program track says: $(cat "$work/track.txt")"
  rm -rf "$work/tracked"
done

# The two packages: what Debian wants is there, and the program runs from where it is unpacked, on an example that came with it.
cpack --config "$build/CPackConfig.cmake" -B "$work/packages" > "$work/cpack.log" 2>&1 || { cat "$work/cpack.log"; exit 1; }
rm -rf "$work/packages/_CPack_Packages"
for name in misfit libmisfit-dev; do
  file=$(echo "$work/packages/${name}"_*.deb)
  [ -f "$file" ] || fail "no package $name"
  dpkg-deb -x "$file" "$work/root"
  [ "$(dpkg-deb -f "$file" Package)" = "$name" ] || fail "$file is called $(dpkg-deb -f "$file" Package)"
  for document in copyright changelog.gz; do
    [ -s "$work/root/usr/share/doc/$name/$document" ] || fail "$name has no $document"
  done
done
dpkg-deb -f "$work"/packages/libmisfit-dev_*.deb Depends | grep -q "misfit (= $(dpkg-deb -f "$work"/packages/misfit_*.deb Version))" ||
  fail "libmisfit-dev does not want the program of its version"
! dpkg-deb -c "$work"/packages/misfit_*.deb | grep -qE '\.(h|a)$' || fail "the program's package has headers or libraries"
for page in misfit misfit-fit misfit-export; do
  gzip -dc "$work/root/usr/share/man/man1/$page.1.gz" | grep -q "^.TH \"${page//-/\\\\-}\"" || fail "no manual page $page"
done
[ -s "$work/root/usr/share/bash-completion/completions/misfit" ] || fail "no completion"
mkdir "$work/home"
(cd "$work/home" && "$work/root/usr/bin/misfit") > "$work/next.txt"
grep -q "cp -r $work/root/usr/share/doc/misfit/examples/cascaded_tanks ." "$work/next.txt" || fail "misfit alone says: $(cat "$work/next.txt")"
cp -r "$work/root/usr/share/doc/misfit/examples/cascaded_tanks" "$work/home"
(cd "$work/home" && env -u LD_LIBRARY_PATH "$work/root/usr/bin/misfit" fit cascaded_tanks --quiet) > "$work/fit.txt" || fail "the unpacked program: $(cat "$work/fit.txt")"
[ -s "$work/home/cascaded_tanks/out/fit/output_error/fit.json" ] || fail "the unpacked program leaves no fit"

# broken NAME: a copy of the project under WORK/NAME, to be spoilt.
broken() {
  mkdir "$work/$1"
  cp -r "$here/CMakeLists.txt" "$here/identify.cpp" "$here/effects" "$work/$1/"
}
configure_broken() { cmake -S "$work/$1" -B "$work/$1/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" "${@:2}" > "$work/$1/log" 2>&1; }

broken twice
mkdir "$work/twice/effects/more"
cp "$here/effects/strut_interference.cpp" "$work/twice/effects/more/"
! configure_broken twice "$@" || fail "two effects of one name are accepted"
tr -s ' \n' '  ' < "$work/twice/log" | grep -q "key 'strut_interference' is taken" || fail "two effects of one name: the message does not say so"

broken misnamed
mv "$work/misnamed/effects/strut_interference.cpp" "$work/misnamed/effects/strut_wake_of_mine.cpp"
configure_broken misnamed "$@" || fail "a misnamed effect should configure"
! cmake --build "$work/misnamed/build" > "$work/misnamed/log" 2>&1 || fail "a file that registers another name than its own is accepted"
grep -q "misfit_register_strut_wake_of_mine" "$work/misnamed/log" || fail "a misnamed effect: the message does not name it"
echo "package: as expected"
