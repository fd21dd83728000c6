#!/bin/sh
# Claims about bundle/run-all, with a false tetrace in its place: tests/program/run_all_test.sh <claim> <folder bundle/>
set -u
claim=$1 source=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/a bundle/bin" "$folder/a bundle/icd" "$folder/programs"
cp "$source/run-all" "$folder/a bundle/"
cp "$source"/icd/* "$folder/a bundle/icd/"
out="$folder/results, all"

fail() { echo "FAILED: $*"; cat "$out/summary.txt" "$folder/said" 2>/dev/null; exit 1; }
# tetrace_is <shell commands>: what the program does; $1 is its verb.
tetrace_is() {
    printf '#!/bin/sh\n%s\n' "$1" >"$folder/a bundle/bin/tetrace"
    chmod +x "$folder/a bundle/bin/tetrace"
}
# run_all <expected exit code> <options...>
run_all() {
    expected=$1; shift
    env -i PATH="$folder/programs:/usr/bin:/bin" "$folder/a bundle/run-all" "$@" >"$folder/printed" 2>"$folder/said"
    code=$?
    [ $code = "$expected" ] || fail "exit code $code, not $expected"
}
summary_has() { grep -Eq "$1" "$out/summary.txt" || fail "no line '$1' in the summary"; }

case $claim in
steps_that_end_well_give_0)
    tetrace_is 'echo "it ran: $*"'
    run_all 0 "$out" --quick
    for step in devices defects check check-all check-rays bench bench-rays stress ladder bench-in-flight bench-losing \
        bench-host bench-schedules render-openmp render-cuda reproduce-rays reproduce; do
        summary_has "^$step +ok "
        grep -q 'it ran' "$out/$step.txt" || fail "what $step printed is not kept"
    done
    summary_has '^0 steps failed, 0 skipped'
    [ ! -e "$out/.work" ] || fail "its working folder is left over" ;;
a_hang_and_a_failure_lose_no_other_step)
    tetrace_is 'case "$*" in
        check*--junit*) echo partly; trap "" TERM; while :; do sleep 1; done ;; # the step "check" alone: it costs 12 s
        esac
        case $1 in
        bench) echo "reason" >&2; exit 1 ;;
        render) kill -SEGV $$ ;;
        esac'
    run_all 1 "$out" --quick --limit 2
    summary_has '^devices +ok '
    summary_has '^check +timed out after 2 s '
    summary_has '^bench-rays +failed with exit code 1 '
    summary_has '^render-cuda +ended by signal 11 '
    grep -q partly "$out/check.txt" || fail "what a hanging step printed is lost"
    grep -q reason "$out/bench.log" || fail "what a failing step said is lost" ;;
the_time_of_all_steps_shortens_later_ones_and_then_skips_them)
    tetrace_is 'case "$1 $*" in "bench "*/bench.json*) exec sleep 1000 ;; esac; echo "it ran: $*"'
    run_all 1 "$out" --quick --limit-all 12
    summary_has '^check +ok '
    grep -Eq '^bench +timed out after [0-9]+ s [(]of 75 s[)]' "$out/summary.txt" || fail "bench was not shortened"
    summary_has '^reproduce +skipped at --limit-all '
    summary_has '^1 steps failed, [0-9]+ skipped, 1[0-9] s in all'
    tetrace_is 'echo "it ran: $*"'
    run_all 0 "$out" --quick --limit-all 60
    budget=$(sed -n 's/.* bench .*--budget \([0-9]*\)s .*/\1/p' "$out/bench.txt")
    [ "$budget" -ge 1 ] && [ "$budget" -le 37 ] || fail "budget '$budget', not 6/10 of at most 60 s" ;;
results_are_added_under_their_commit_with_a_page)
    tetrace_is 'case $1 in report) shift; while [ "$1" != --out ]; do shift; done; echo page >"$2" ;; devices) exit 0 ;; esac
        while [ $# -gt 0 ] && [ "$1" != --out ]; do shift; done
        case ${2-} in *.json) ;; *) exit 0 ;; esac
        echo "{\"date\":\"2026-11-28T06:00:00Z\",\"commit\":\"0123abc\"}" >"$2"'
    run_all 0 "$out" --quick
    "$source/../scripts/add-results" "$out" "$folder/results" "$folder/a bundle/bin/tetrace" || fail "exit code $?"
    for name in bench.json check.json summary.txt; do
        [ -s "$folder/results/2026-11-28-0123abc-$name" ] || fail "no $name: $(ls "$folder/results")"
    done
    grep -q page "$folder/results/report.html" || fail "no page"
    ! "$source/../scripts/add-results" "$folder" "$folder/results" 2>/dev/null || fail "a folder without a run is taken" ;;
known_defects_of_compilers_are_no_failure)
    tetrace_is 'case "$*" in *--defects*) exit 1 ;; esac'
    run_all 0 "$out" --quick
    summary_has '^defects +ok '
    tetrace_is 'case "$*" in *--defects*) exit 4 ;; esac'
    run_all 1 "$out" --quick
    summary_has '^defects +failed with exit code ' ;;
what_is_packed_is_unpacked_for_the_steps)
    mkdir "$folder/a bundle/lib" "$folder/a bundle/scenes"
    cp /usr/bin/xz "$folder/a bundle/bin/" || { echo "skipped: no xz"; exit 77; }
    echo library | xz >"$folder/a bundle/lib/libpacked.so.xz"
    echo scene | xz >"$folder/a bundle/scenes/bunny-rays.tet.xz"
    tetrace_is 'cat "${LD_LIBRARY_PATH%%:*}/libpacked.so" && case "$*" in *bunny-rays.tet*) cat bunny-rays.tet ;; esac'
    run_all 0 "$out" --quick
    grep -q library "$out/devices.txt" || fail "the library is not found"
    grep -q scene "$out/bench.txt" || fail "the scene is not found" ;;
each_gpu_has_its_share_of_the_tables)
    printf '#!/bin/sh\necho "GPU 0: one"; echo "GPU 1: another"; echo "GPU 2: a third"\n' >"$folder/programs/nvidia-smi"
    chmod +x "$folder/programs/nvidia-smi"
    tetrace_is 'case $1 in reproduce)
        [ $PMI_RANK != 0 ] || sleep 1 # rank 0 waits for the others
        echo "$TETRACE_LAUNCH: $PMI_RANK of $PMI_SIZE on $MPI_LOCALRANKID" ;;
        esac'
    run_all 0 "$out" --quick
    [ "$(sed 's/.*: //' "$out/reproduce.txt" | sort)" = "$(printf '%s of 3 on %s\n' 0 0 1 1 2 2)" ] || fail "other ranks"
    [ "$(sed 's/:.*//' "$out/reproduce.txt" | sort -u | wc -l)" = 1 ] || fail "ranks of several launches"
    tetrace_is 'case "$1 $PMI_RANK" in "reproduce 0") sleep 1; exit 1 ;; "reproduce "*) echo $$ >>"'"$folder"'/shares"; exec sleep 1000 ;; esac'
    run_all 1 "$out" --quick --limit 3
    summary_has '^reproduce +failed with exit code 1 '
    tetrace_is 'case $1 in reproduce) echo $$ >>"'"$folder"'/shares"; exec sleep 1000 ;; esac'
    run_all 1 "$out" --quick --limit 3
    summary_has '^reproduce +timed out after 3 s '
    [ "$(wc -l <"$folder/shares")" -ge 10 ] || fail "not all shares began" # two steps of two others, two of three
    patience=50 # tenths of a second, until the system has buried them
    for process in $(cat "$folder/shares"); do
        while kill -0 "$process" 2>/dev/null; do
            [ $((patience -= 1)) -gt 0 ] || fail "a share runs on"
            sleep 0.1
        done
    done ;;
a_hanging_look_for_devices_costs_no_picture_of_other_apis)
    tetrace_is 'case "$*" in *"--require vulkan"*) exec sleep 1000 ;; esac'
    run_all 0 "$out" --quick --limit 2
    summary_has '^render-cuda +ok '
    ! grep -q '^render-vulkan' "$out/summary.txt" || fail "an API without a device was rendered" ;;
the_summary_is_json_too)
    command -v python3 >/dev/null || { echo "skipped: no python3 to read JSON with"; exit 77; }
    tetrace_is 'test $1 != bench'
    run_all 1 "$out" --quick
    python3 - "$out/summary.json" <<'END' || fail "summary.json is not what was expected"
import json, sys
steps = {step["step"]: step for step in json.load(open(sys.argv[1]))["steps"]}
assert steps["check"]["result"] == "ok" and steps["check"]["exit_code"] == 0, steps
assert steps["bench"]["exit_code"] == 1 and steps["bench"]["seconds"] >= 0, steps
END
    ;;
an_interrupt_ends_the_step_and_keeps_the_summary)
    tetrace_is 'case $1 in bench) echo $$ >"'"$folder"'/process"; exec sleep 1000 ;; esac'
    env -i PATH=/usr/bin:/bin "$folder/a bundle/run-all" "$out" --quick >"$folder/printed" 2>"$folder/said" &
    until [ -s "$folder/process" ]; do sleep 0.1; done
    kill -TERM $!
    wait $!
    code=$?
    [ $code = 1 ] || fail "exit code $code, not 1"
    summary_has '^devices +ok '
    summary_has '^bench +interrupted '
    ! kill -0 "$(cat "$folder/process")" 2>/dev/null || fail "the step runs on" ;;
refuses_what_it_does_not_know)
    tetrace_is 'exit 0'
    run_all 2
    run_all 2 "$out" --slow
    run_all 2 "$out" --patience 0
    run_all 2 "$out" --limit
    run_all 2 "$out" --limit-all 0
    run_all 2 "$out" "$out.more"
    [ ! -e "$out" ] || fail "a folder was made all the same"
    run_all 0 --help
    : >"$folder/file"
    run_all 3 "$folder/file/below" ;;
*) echo "unknown claim '$claim'"; exit 2 ;;
esac
