#!/bin/sh
# Claims about the bundle that was built: tests/program/bundle_test.sh <claim> <bundle> <folder of the stub CUDA driver, or empty>
set -u
claim=$1 bundle=$2 stub=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

# As on another machine: elsewhere, in a folder with a space, without our environment, without the OpenCL and Vulkan
# drivers of this system.
cp -r "$bundle" "$folder/the bundle" || fail "copying $bundle"
bare() {
    env -i PATH=/usr/bin:/bin OMP_WAIT_POLICY=passive TETRACE_QUICK_COPIES=1 LD_LIBRARY_PATH="$stub" OCL_ICD_VENDORS="$folder/none" \
        VK_DRIVER_FILES="$folder/none.json" VK_ICD_FILENAMES="$folder/none.json" "$@"
}

case $claim in
brings_every_library_but_the_systems)
    # as its README says, by hand
    (cd "$folder/the bundle" && LD_LIBRARY_PATH=lib bin/xz -dk lib/*.xz scenes/*.xz) || fail "unpacking it"
    env -i LD_TRACE_LOADED_OBJECTS=1 "$folder/the bundle/bin/tetrace" >"$folder/libraries" || fail "it does not start"
    foreign=$(grep '=>' "$folder/libraries" | grep -v "=> $folder/the bundle/" |
        grep -Ev '^[[:space:]]*lib(c|m|dl|rt|pthread|util)\.so')
    [ -z "$foreign" ] || fail "of this system and not of the bundle: $foreign"
    grep -q 'libembree.*the bundle' "$folder/libraries" || fail "Embree is not among: $(cat "$folder/libraries")"
    bare "$folder/the bundle/bin/tetrace" --version || fail "it does not start by itself"
    [ ! -e "$folder/the bundle/scenes/banana.tet" ] || bare "$folder/the bundle/bin/tetrace" build --scene \
        "$folder/the bundle/scenes/banana-rays.tet" --views 0 --size 64 --format json | grep -q '"tets_kind": *"rays"' ||
        fail "banana-rays.tet lacks tets for rays" ;;
states_licences_and_the_c_library)
    grep -Eq 'glibc 2\.[0-9]+ or newer' "$bundle/README" || fail "README names no version of glibc"
    for library in "$bundle"/lib/*.so*; do
        real=$(readlink -f "/usr/lib/$(uname -m)-linux-gnu/$(basename "$library" .xz)") || continue
        package=$(dpkg-query -S "$real" "${real#/usr}" 2>/dev/null | head -n 1 | cut -d: -f1)
        [ -z "$package" ] || [ -s "$bundle/licences/$package" ] || fail "no licence of $package, which $library is of"
    done ;;
traces_without_this_systems_drivers)
    bare "$folder/the bundle/bin/tetrace" check --scene cubes --resolution 4 --size 16 --backend openmp,embree \
        ${stub:+--backend cuda} --out "$folder/check.json" || fail "check ended with $?"
    bare "$folder/the bundle/bin/tetrace" render --scene cubes --views 0 --size 16 --out "$folder/picture.ppm" || fail "no picture" ;;
runs_all_steps_without_this_systems_drivers)
    bare "$folder/the bundle/run-all" "$folder/out" --quick --patience 6 || {
        tail -n 20 "$folder"/out/*.log
        fail "run-all ended with $?"
    }
    for file in devices.json defects.json check.json check.xml check-all.json check-rays.json bench.json bench-rays.json \
        ladder.json bench-losing.json bench-host.json bench-schedules.json reproduce-rays.json reproduce.json; do
        [ -s "$folder/out/$file" ] || fail "no $file"
    done
    ls "$folder"/out/pictures-openmp/*.ppm || fail "no pictures"
    # without compiled kernels and NVRTC it has none
    [ -z "$stub" ] || grep -q 'was built without compiled CUDA kernels' "$folder/out/devices.txt" ||
        grep -q '^render-cuda  *ok' "$folder/out/summary.txt" || fail "the stub CUDA driver had no rows" ;;
*) echo "unknown claim '$claim'"; exit 2 ;;
esac
