#!/usr/bin/env bash
# Kills renders at random moments: the image is whole or absent, and --resume ends with the bits of an uninterrupted
# render. Then the other faults: no memory, a full disk, a file that may not grow, a folder that is none or is read-only,
# each with its message and status, and nothing half written left behind.
# usage: kill_test.sh PELLUCID SCENE [KILLS, default 50]
set -euo pipefail
pellucid=$1 scene=$2 kills=${3:-50}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
RANDOM=1 # the same moments each time, as far as the machine allows

fail() {
    echo "kill_test: $1" >&2
    exit 4
}
render() { "$pellucid" render "$scene" --size 48x36 --spp 24 --seed 5 --quiet "$@"; }
same() { "$pellucid" diff "$work/whole.exr" "$1" --fail-above rmse=0 --fail-above nonfinite=0 >/dev/null; }

render -o "$work/whole.exr"
started=$(date +%s%N)
render -o "$work/timed.exr"
span=$((($(date +%s%N) - started) / 1000000))
same "$work/timed.exr" || fail "two renders of one seed differ"

finished=0 resumed=0
for ((i = 0; i < kills; ++i)); do
    signals=(KILL INT KILL TERM) # SIGINT and SIGTERM write what there is, and a checkpoint (143: before the program had begun)
    signal=${signals[$((i % 4))]}
    render -o "$work/out.exr" --checkpoint "$work/state" --resume &
    child=$!
    sleep "$(awk -v ms=$((RANDOM % (span + 1))) 'BEGIN { print ms / 1000 }')"
    kill -$signal $child 2>/dev/null || true
    status=0
    wait $child 2>/dev/null || status=$?
    case $status in 0 | 130 | 137 | 143) ;; *) fail "a killed render ended with $status" ;; esac
    [ ! -e "$work/state" ] || resumed=$((resumed + 1))
    if [ $status -eq 0 ]; then
        same "$work/out.exr" || fail "a resumed render has other bits"
        finished=$((finished + 1))
        rm -f "$work/state"
    elif [ -e "$work/out.exr" ]; then # of an interrupted render: whole, though noisy
        "$pellucid" diff "$work/whole.exr" "$work/out.exr" >/dev/null || fail "a killed render left a broken image"
    fi
    rm -f "$work/out.exr"
done
render -o "$work/out.exr" --checkpoint "$work/state" --resume
same "$work/out.exr" || fail "the resumed render has other bits than the uninterrupted one"

# STATUS, WORDS of the message, command
expect() {
    local status=0
    "${@:3}" >/dev/null 2>"$work/err" || status=$?
    [ $status -eq "$1" ] || fail "status $status instead of $1: ${*:3}"
    { [ "$(wc -l <"$work/err")" -eq 1 ] && grep -q "pellucid: error: .*$2" "$work/err"; } || fail "not one line with '$2': $(cat "$work/err")"
}
expect 3 "" render -o "$work/no/such/folder/out.exr"
expect 3 "" render -o /dev/full/out.exr
expect 3 "" render -o /proc/out.exr # no permission would stop root
if [ "$(id -u)" -ne 0 ]; then
    mkdir "$work/readonly" && chmod 555 "$work/readonly"
    expect 3 "" render -o "$work/readonly/out.exr"
fi
big() { "$pellucid" render "$scene" --size 200x150 --method path --spp 1 --quiet "$@"; }
# A disk of 64 KiB where one may be made, and a limit on files anywhere: for the image, the record, the checkpoint.
mkdir "$work/small"
if mount -t tmpfs -o size=64k tmpfs "$work/small" 2>/dev/null; then
    trap 'umount "$work/small"; rm -rf "$work"' EXIT
    expect 3 "space" big -o "$work/small/out.exr"
    expect 3 "space" big -o "$work/small/out.png" --checkpoint "$work/small/state"
fi
no_room() { (ulimit -f 16 && big "$@"); }
expect 3 "space" no_room -o "$work/small/out.exr"
expect 3 "space" no_room -o "$work/small/out.png" --checkpoint "$work/small/state"
[ -z "$(ls -A "$work/small")" ] || fail "writes that failed left $(ls -A "$work/small")"
expect 3 "standard output" bash -c "'$pellucid' diff '$work/whole.exr' '$work/out.exr' >/dev/full"
no_memory() { (ulimit -v 2000000 && "$pellucid" render "$scene" -o "$work/big.exr" --size 20000x20000 --spp 1 --quiet); }
# (An address sanitizer reserves more than this limit for itself.)
grep -q __asan_init "$pellucid" || expect 3 "memory" no_memory
[ ! -e "$work/big.exr" ] || fail "a render without memory left an image"
echo "kill_test: $kills kills, $finished renders ended in time, $resumed checkpoints; the rest is as it should be"
