#!/usr/bin/env bash
# Opens a report.html in headless Chromium, works its controls and holds what it sees: curves drawn, slider moves, the
# pixel under the pointer is that of the EXR, no console error, no network request.
# usage: check_report.sh FOLDER-OF-A-COMPARISON
#        check_report.sh --make PELLUCID SCENE   makes a small comparison first
# Where chromium, oiiotool or python3 is missing it says so and exits with 77, which ctest shows as skipped.
set -euo pipefail
for tool in chromium oiiotool python3; do
    command -v "$tool" >/dev/null || { echo "skipped: $tool is missing"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
if [ "$1" = --make ]; then
    folder=$work/comparison
    "$2" compare "$3" -o "$folder" --methods path,photon:cache.error=0.3,light --times 0.2,0.4 --seeds 3 --size 40x30 \
        --reference-time 2 --quiet
else
    folder=$(cd "$1" && pwd)
fi

# The page with a script behind it that acts as a user and writes what it found.
cp "$folder/report.html" "$work/page.html"
cat >>"$work/page.html" <<'SCRIPT'
<script>
"use strict";
const found = {};
found.ready = document.documentElement.dataset.ready === "true";
found.curves = document.querySelectorAll("#curves path.line").length;
found.methods = methods.length;
found.longestCurve = Math.max(...Array.from(document.querySelectorAll("#curves path.line"), p => (p.getAttribute("d") || "").length));
const divider = document.getElementById("divider"), before = divider.getAttribute("aria-valuenow");
divider.dispatchEvent(new KeyboardEvent("keydown", {key: "PageUp", bubbles: true}));
found.sliderMoved = divider.getAttribute("aria-valuenow") !== before;
for (const mode of ["luminance", "error", "colour"]) { const m = document.getElementById("mode"); m.value = mode; m.onchange(); }
const exposure = document.getElementById("exposure"); exposure.value = 2; exposure.oninput();
// The pointer goes to the median of the left picture's lit pixels: a value that is none of black, white and the same all over.
const shown = decode(view.left), lit = Array.from({length: shown.length / 3}, (_, i) => i).filter(i => shown[3 * i + 1] > 0).sort((a, b) => shown[3 * a + 1] - shown[3 * b + 1]);
const target = lit[lit.length >> 1], box = document.getElementById("canvas").getBoundingClientRect();
document.getElementById("viewer").dispatchEvent(new PointerEvent("pointermove", {pointerId: 1, bubbles: true,
  clientX: box.left + (target % view.left.width + .5) / view.left.width * box.width, clientY: box.top + (Math.floor(target / view.left.width) + .5) / view.left.height * box.height}));
found.pixel = JSON.parse(document.getElementById("pixel").dataset.values);
const l = view.left, run = report.curves.find(r => r.method === l.label && r.budget === l.budget && r.seed === l.seed);
found.requests = performance.getEntriesByType("resource").map(r => r.name).filter(n => !/^(data|blob):/.test(n));
// Zoom and pan by the keyboard move both pictures; the legend's buttons hide a curve and bring it back.
const keyed = key => document.getElementById("viewer").dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
document.getElementById("pixel").textContent = ""; keyed("+"); keyed("+"); const zoomed = view.zoom, panned = view.x; keyed("ArrowRight");
found.zoomed = zoomed > 2 && view.x > panned; found.keyRead = document.getElementById("pixel").textContent.startsWith("pixel ");
// The small pictures show the same cut as the large one: the zoomed reference is another picture than the whole one.
const small = () => Array.from(document.querySelectorAll("#strip canvas"), c => c.toDataURL());
drawStrip(); const cut = small(); keyed("0"); drawStrip(); const whole = small();
found.small = whole.length; found.smallFollow = [0, 1, 2].every(i => cut[i] !== whole[i]) && new Set(whole).size === whole.length;  // that of light alone may be black
found.reset = view.zoom === 1 && view.x === 0;
document.querySelector("#strip button").click(); found.chosen = document.getElementById("right").value === "reference" && view.right === reference;
const button = document.querySelector("#legend button"); button.click();
found.hidden = document.querySelectorAll("#curves path.line").length; button.click();
const scale = document.getElementById("class-scale"); scale.value = "own"; scale.onchange();
found.bars = document.querySelectorAll("#classes rect").length; found.maps = document.querySelectorAll("#maps figure").length; found.kinds = document.querySelectorAll("#maps h3").length;
found.rows = document.querySelectorAll("#figures tbody tr").length; found.plans = document.querySelectorAll("#plans details").length;
found.commands = document.querySelectorAll("#commands pre").length;
// Every control has a name that a screen reader can say, and nothing is wider than the page.
found.nameless = Array.from(document.querySelectorAll("button, select, input, [role=slider], [role=application], [role=img]")).filter(e =>
  !(e.getAttribute("aria-label") || e.textContent.trim() || (e.closest("label") && e.closest("label").textContent.trim()))).length;
found.wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
found.image = run.image; found.bytes = l.bytes; found.halved = l.halved;
for (const s of document.querySelectorAll("script[type]")) s.remove();
document.body.append("FOUND" + JSON.stringify(found) + "END");
</script>
SCRIPT

fail() {
    echo "check_report: $1" >&2
    exit 4
}

# Opens the page in a window of WIDTH,HEIGHT and holds what the script found.
look() {
    chromium --headless --no-sandbox --window-size="$1" --disable-gpu --disable-quic --no-first-run \
        --disable-background-networking --disable-component-update --disable-sync --user-data-dir="$work/profile" \
        --enable-logging=stderr --host-resolver-rules="MAP * ~NOTFOUND" --virtual-time-budget=5000 --dump-dom \
        "file://$work/page.html" >"$work/dom.html" 2>"$work/log"
    ! grep 'CONSOLE' "$work/log" || fail "the console is not empty"
    found=$(grep -oE 'FOUND\{.*\}END' "$work/dom.html" | sed 's/^FOUND//; s/END$//') || fail "the script did not finish"
    python3 "$work/hold.py" "$folder" "$work" "$found" || fail "in a window of $1"
}

cat >"$work/hold.py" <<'PYTHON'
import json, struct, subprocess, sys
folder, work, found = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
assert found["ready"], "the page did not finish"
assert found["curves"] == found["methods"] and found["longestCurve"] > 5, "curves are missing"
assert not found["requests"], "the page asked for " + str(found["requests"])
assert found["sliderMoved"], "the slider did not move"
assert found["zoomed"] and found["reset"], "zoom and pan do not answer the keyboard"
assert found["keyRead"], "the keyboard reads no pixel"
assert found["small"] == found["methods"] + 1 and found["smallFollow"], "the small pictures do not follow zoom and pan"
assert found["chosen"], "a small picture cannot be chosen"
assert found["maps"] == 3 * found["methods"] and found["kinds"] == 3, "error, bias or deviation maps are missing"
assert found["hidden"] == found["methods"] - 1, "the legend hides no curve"
for part in ("bars", "maps", "rows", "plans", "commands"):
    assert found[part] > 0, part + " are missing"
assert found["nameless"] == 0, f"{found['nameless']} controls have no name"
assert found["wide"] <= 0, f"the page is {found['wide']} pixels wider than its window"
assert not found["halved"], "this report's pictures are halved: check one with smaller images"
p = found["pixel"]
# One pixel as an uncompressed TIFF file of floats: its data stand where tag 273 (StripOffsets) says.
subprocess.run(["oiiotool", f"{folder}/{found['image']}", "--ch", "R,G,B", "--cut", f"1x1+{p['x']}+{p['y']}", "-d", "float",
                "--compression", "none", "-o", f"{work}/pixel.tif"], check=True)
tiff = open(f"{work}/pixel.tif", "rb").read()
directory = struct.unpack_from("<I", tiff, 4)[0]
tags = (struct.unpack_from("<HHII", tiff, directory + 2 + 12 * i) for i in range(struct.unpack_from("<H", tiff, directory)[0]))
exr = struct.unpack_from("<3f", tiff, next(value for tag, kind, count, value in tags if tag == 273))
tolerance = {4: 0.0, 3: 2.0 ** -16, 2: 2.0 ** -11}[found["bytes"]]
for shown, value in zip(p["left"], exr):
    assert abs(shown - value) <= tolerance * abs(value), (p, exr)
print(f"report: {found['curves']} curves, slider, pixel {p['x']},{p['y']} = {exr} ({found['bytes']} bytes a value), no console output, no request")
PYTHON

look 1200,900
look 390,844
