#!/usr/bin/env bash
# Makes the pictures and the table of figures in README.md, all in one go: the title picture, and one scene by path
# tracing, by photon maps in the same seconds, and a bidirectional reference of many more. `./run docs images` builds first.
#
#   README_SECONDS=20  README_REFERENCE_SECONDS=300  README_TITLE_SECONDS=60  README_SIZE=320x320  README_THREADS=2
#   README_WORK=build/readme  PELLUCID=build/release/pellucid
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."

pellucid="${PELLUCID:-build/release/pellucid}"
work="${README_WORK:-build/readme}"
seconds="${README_SECONDS:-20}"
reference_seconds="${README_REFERENCE_SECONDS:-300}"
title_seconds="${README_TITLE_SECONDS:-60}"
size="${README_SIZE:-320x320}"
threads="${README_THREADS:-2}"
scene=scenes/glass-and-mirror.glb
mkdir -p "$work" docs/images

render() { # METHOD SECONDS SEED NAME
    "$pellucid" render "$scene" --method "$1" --time "$2" --seed "$3" --size "$size" --threads "$threads" --quiet \
        -o "$work/$4.exr" -o "docs/images/$4.png" --record "$work/$4.json"
}
value() { sed -n "s/.*\"$2\"[[:space:]]*:[[:space:]]*\([^,}[:space:]]*\).*/\1/p" "$1" | sed -n 1p; }
rounded() { awk -v x="$1" 'BEGIN { printf "%.3g", x }'; }

title=(render scenes/goblet.glb --time "$title_seconds" --size 640x400 --exposure 0.5)
"$pellucid" "${title[@]}" -o docs/images/title.png --threads "$threads" --quiet
render path "$seconds" 1 path
render photon "$seconds" 1 photon
render bdpt "$reference_seconds" 2 reference # unbiased, and far less noisy at caustics than path tracing
for method in path photon; do
    "$pellucid" diff "$work/reference.exr" "$work/$method.exr" --json >"$work/$method.diff.json"
done

column() { # METHOD: its error as a cell; trimmed: without the worst 0.1 % of the pixels, where fireflies are
    local file="$work/$1.diff.json"
    echo "relMSE $(rounded "$(value "$file" relmse)"), trimmed $(rounded "$(value "$file" relmse_trimmed)"), FLIP $(rounded "$(value "$file" flip)")"
}
{
    echo "| path, $seconds s | photon, $seconds s | reference, $reference_seconds s |"
    echo "|---|---|---|"
    echo "| ![path](docs/images/path.png) | ![photon](docs/images/photon.png) | ![reference](docs/images/reference.png) |"
    echo "| $(column path) | $(column photon) | bidirectional path tracing, another seed |"
    echo
    echo "\`$scene\`, $size, $threads threads, loading and all preprocessing within the seconds; trimmed: relMSE without the worst"
    echo "0.1 % of the pixels. Command: \`./run docs images\`."
} >"$work/figures.md"

awk -v table="$work/figures.md" -v title="\`build/release/pellucid ${title[*]} -o title.png\`" '
    /^`build\/release\/pellucid render scenes\/goblet/ { print title; next }
    /<!-- figures -->/ { print; while ((getline line < table) > 0) print line; skip = 1; next }
    /<!-- end of figures -->/ { skip = 0 }
    !skip { print }' README.md >"$work/README.md"
cp "$work/README.md" README.md
echo "make_images: docs/images/*.png and the figures in README.md are new"
