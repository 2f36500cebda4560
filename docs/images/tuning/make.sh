#!/usr/bin/env bash
# Renders the pictures of docs/tuning.md: each parameter too small, right and too large, all else as the plan decides, and
# prints what each cost. Needs oiiotool and python3. usage: docs/images/tuning/make.sh [PELLUCID [PARAMETER]]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
pellucid=${1:-build/release/pellucid}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# parameter, scene, samples a pixel, what is shown, three values, further settings
pictures() {
    while read -r key scene samples shown low right high more; do
        for place in 1-little:$low 2-right:$right 3-much:$high; do
            picture="docs/images/tuning/$key-${place%%:*}.png"
            # shellcheck disable=SC2086
            "$pellucid" render "scenes/$scene.glb" --quiet --size 160x120 --spp "$samples" --set "$key=${place#*:}" $more \
                -o "$work/image.exr" -o "$picture" --record "$work/record.json"
            if [ "$shown" = indirect ]; then # alone and brighter: direct light would hide what a cache does
                oiiotool "$work/image.exr" --ch R=indirect.R,G=indirect.G,B=indirect.B --mulc 2.5 --colorconvert linear sRGB \
                    -d uint8 -o "$picture"
            fi
            python3 - "$key" "${place#*:}" "$work/record.json" <<'PYTHON'
import json, sys
rays = sum(stage["rays"] for stage in json.load(open(sys.argv[3]))["stages"])
print(f"{sys.argv[1]}={sys.argv[2]}: {rays / 1e6:.1f} million rays")
PYTHON
        done
    done
}

grep "^${2:-}" <<'LIST' | pictures
cache.error diffuse-room 1 indirect 0.06 auto 3
cache.rays diffuse-room 1 indirect 24 auto 3000
cache.min_spacing diffuse-room 1 indirect 0.3 auto 25
cache.max_spacing diffuse-room 1 indirect 5 auto 400
photon.global diffuse-room 1 indirect 300 auto 600000
photon.caustic glass-and-mirror 2 all 1000 auto 400000
photon.radius ring 4 all 0.5 auto 15
photon.alpha ring 16 all 0.3 0.667 1 --set photon.radius=10
surface.cast_roughness rough-metal 4 all 0 0.3 0.6
LIST
