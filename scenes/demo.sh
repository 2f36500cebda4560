#!/usr/bin/env bash
# Renders one scene by photon maps and by path tracing for the same seconds, and bidirectionally for longer as the reference, and prints each
# one's relMSE without the worst 0.1 % of pixels (a reference of a minute has fireflies). Pictures go to ./demo-out. `./run demo` builds first and then calls this.
#
#   scenes/demo.sh [SCENE.glb]
#   DEMO_SECONDS=20  DEMO_REFERENCE_SECONDS=60  DEMO_SIZE=512x512  DEMO_OUT=demo-out  PELLUCID=build/release/pellucid
set -euo pipefail
export LC_ALL=C

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
scene="${1:-$root/scenes/glass-and-mirror.glb}"
pellucid="${PELLUCID:-$root/build/release/pellucid}"
out="${DEMO_OUT:-demo-out}"
seconds="${DEMO_SECONDS:-20}"
reference_seconds="${DEMO_REFERENCE_SECONDS:-60}"
size=()
[ -n "${DEMO_SIZE:-}" ] && size=(--size "$DEMO_SIZE")

if [ ! -x "$pellucid" ]; then
    echo "demo: error: there is no program to run ($pellucid): run ./run build first" >&2
    exit 2
fi
mkdir -p "$out"

# render METHOD SECONDS SEED: writes METHOD.exr and METHOD.png, and the seconds that it took to METHOD.seconds.
render() {
    local method="$1" budget="$2" seed="$3" start="$EPOCHREALTIME"
    echo "demo: $method for $budget s ..." >&2
    rm -f "$out/$method.exr" "$out/$method.png" "$out/$method.seconds"
    "$pellucid" render "$scene" --method "$method" --time "$budget" --seed "$seed" ${size[@]+"${size[@]}"} \
        -o "$out/$method.exr" -o "$out/$method.png" || return
    awk -v start="$start" -v end="$EPOCHREALTIME" 'BEGIN { printf "%.1f\n", end - start }' >"$out/$method.seconds"
}

# error_of METHOD: its relmse against the reference.
error_of() {
    "$pellucid" diff "$out/bdpt.exr" "$out/$1.exr" --json |
        sed -n 's/.*"relmse_trimmed"[[:space:]]*:[[:space:]]*\([^,}[:space:]]*\).*/\1/p' | sed -n 1p
}

render photon "$seconds" 1
render path "$seconds" 1
status=0
render bdpt "$reference_seconds" 2 || status=$?
[ "$status" -eq 130 ] && exit 130
[ "$status" -ne 0 ] && echo "demo: no reference (exit status $status), so no errors below" >&2

echo
printf '%-10s %8s %12s\n' method seconds relMSE
for method in photon path; do
    error=-
    [ "$status" -eq 0 ] && error="$(error_of "$method")"
    printf '%-10s %8s %12s\n' "$method" "$(<"$out/$method.seconds")" \
        "$(awk -v e="${error:--}" 'BEGIN { if (e ~ /^[0-9]/) printf "%.3g", e; else print e }')"
done
[ "$status" -eq 0 ] && printf '%-10s %8s %12s\n' reference "$(<"$out/bdpt.seconds")" '(reference)'
echo
echo "pictures: $out/photon.png, $out/path.png$([ "$status" -eq 0 ] && echo ", $out/bdpt.png") (and .exr)"
