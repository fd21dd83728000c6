#!/bin/sh
# Claims about bundle/run-all, with a false tetrace in its place: tests/program/run_all_test.sh <claim> <folder bundle/>
set -u
claim=$1 source=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/a bundle/bin" "$folder/a bundle/icd"
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
    env -i PATH=/usr/bin:/bin "$folder/a bundle/run-all" "$@" >"$folder/printed" 2>"$folder/said"
    code=$?
    [ $code = "$expected" ] || fail "exit code $code, not $expected"
}
summary_has() { grep -Eq "$1" "$out/summary.txt" || fail "no line '$1' in the summary"; }

case $claim in
steps_that_end_well_give_0)
    tetrace_is 'echo "it ran: $*"'
    run_all 0 "$out" --quick
    for step in devices check bench bench-8x4 bench-8x8 bench-fast render-openmp render-cuda reproduce; do
        summary_has "^$step +ok "
        grep -q 'it ran' "$out/$step.txt" || fail "what $step printed is not kept"
    done
    summary_has '^0 steps failed'
    [ ! -e "$out/.work" ] || fail "its working folder is left behind" ;;
a_hang_and_a_failure_lose_no_other_step)
    tetrace_is 'case $1 in
        check) echo partly; trap "" TERM; while :; do sleep 1; done ;;
        bench) echo "reason" >&2; exit 1 ;;
        render) kill -SEGV $$ ;;
        esac'
    run_all 1 "$out" --quick --limit 2
    summary_has '^devices +ok '
    summary_has '^check +timed out after 2 s '
    summary_has '^bench-fast +failed with exit code 1 '
    summary_has '^render-cuda +ended by signal 11 '
    grep -q partly "$out/check.txt" || fail "what a hanging step printed is lost"
    grep -q reason "$out/bench.log" || fail "what a failing step said is lost" ;;
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
    tetrace_is 'case $1 in check) echo $$ >"'"$folder"'/process"; exec sleep 1000 ;; esac'
    env -i PATH=/usr/bin:/bin "$folder/a bundle/run-all" "$out" --quick >"$folder/printed" 2>"$folder/said" &
    until [ -s "$folder/process" ]; do sleep 0.1; done
    kill -TERM $!
    wait $!
    code=$?
    [ $code = 1 ] || fail "exit code $code, not 1"
    summary_has '^devices +ok '
    summary_has '^check +interrupted '
    ! kill -0 "$(cat "$folder/process")" 2>/dev/null || fail "the step runs on" ;;
refuses_what_it_does_not_know)
    tetrace_is 'exit 0'
    run_all 2
    run_all 2 "$out" --slow
    run_all 2 "$out" --patience 0
    run_all 2 "$out" --limit
    run_all 2 "$out" "$out.more"
    [ ! -e "$out" ] || fail "a folder was made all the same"
    run_all 0 --help
    : >"$folder/file"
    run_all 3 "$folder/file/below" ;;
*) echo "unknown claim '$claim'"; exit 2 ;;
esac
