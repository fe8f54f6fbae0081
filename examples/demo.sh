#!/usr/bin/env bash
# The main job from end to end: overlapping pictures in, a stored lens profile and corrected pictures out.
#
#   examples/demo.sh                  on a sequence that `lensprof simulate` renders
#   examples/demo.sh folder           on yours: overlapping pictures
#   examples/demo.sh dir/pano.pto     the same, by a Hugin project whose pictures are aligned
set -euo pipefail
cd "$(dirname "$0")/.."
lensprof=$PWD/build/lensprof
work=$PWD/build/demo
database=$work/profiles.db
pictures=${1:-}  # a folder or a project

say() { printf '\n== %s\n' "$*"; }
run() { printf '$ lensprof'; printf ' %q' "$@"; printf '\n'; "$lensprof" "$@"; }

mkdir -p "$work"
rm -rf "$database" "$work/corrected" "$work/result.pto" "$work/contact-sheet.png"
if [[ -z $pictures ]]; then
    say "Render six overlapping pictures with a known camera"
    rm -rf "$work/pictures"
    run simulate -o "$work/pictures" --images 6 --size 1200x800 --response srgb --vignetting=-0.30,0.05,-0.15 \
        --center 0.02,-0.015 --ev 1 --wb 0.15 --noise 2 --format jpeg,tiff16 --seed 3
    pictures=$work/pictures
    options=(--compare "$work/pictures/truth.json")
else
    options=(--free all)
fi

say "Recover response, falloff, exposure and white balance; store the profile"
source=(--from-db)
code=0
run build "$pictures" --db "$database" --pto-out "$work/result.pto" "${options[@]}" || code=$?
if [[ $code -eq 2 ]]; then
    source=(--profile 1)
    echo "The pictures do not say which camera took them: stored as 'Demo camera'."
    run build "$pictures" --db "$database" --pto-out "$work/result.pto" "${options[@]}" \
        --camera "Demo camera" --lens "Demo lens"
elif [[ $code -ne 0 ]]; then
    exit "$code"
fi

say "Look the profile up again"
stored=$("$lensprof" profile list --db "$database" --json)
field() { sed -n "s/.*\"$1\":\"\([^\"]*\)\".*/\1/p" <<<"$stored"; }
key=(--camera "$(field camera_model)")
[[ -z $(field lens) ]] || key+=(--lens "$(field lens)")
run query --db "$database" "${key[@]}"

say "Correct the pictures"
run apply "${source[@]}" --db "$database" --pto "$work/result.pto" -o "$work/corrected" \
    --contact-sheet "$work/contact-sheet.png"

say "Before (upper rows) and after (lower rows): $work/contact-sheet.png"
