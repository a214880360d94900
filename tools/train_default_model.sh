#!/bin/bash
# Makes the models inside clvr again: volumes that clvr computes, views of each in five kinds of light, then the training.
# Usage: [CLVR_LEAVE_OUT="KIND..."] train_default_model.sh DIR [CLVR [default|small]]
#   default   the model that reads all channels of clvr's frames, of 26 views a volume; on the way to it `features`, which reads no light
#   small     those for other renderers' pictures, color and color-albedo-normal, of 9 views a volume with references of half the samples;
#             the ones in datasets/models had fewer epochs and volumes: datasets/results/small_models.md
# CLVR_LEAVE_OUT names kinds of volumes (the list below) not to train on, as "machine rock", to cross-validate. The models go to
# DIR/without-machine-rock, test pairs of those kinds to DIR/machine-test and DIR/rock-test for `clvr eval`; all other pairs in DIR are shared.
# head, head-closed and skull have the same bones: leave them out together.
# Continues where it was interrupted. On two cores: about 3 hours for the 292 views of default (13 to 50 s each), 40 minutes for its training; on a
# large GPU minutes.
set -euo pipefail
folder=$1
clvr=${2:-build/release/clvr}
models=${3:-default}
tools=$(dirname "$0")
mkdir -p "$folder/volumes"
case $models in
    default) sky_views=10 light_views=5 hdr_views=6 fixed_views=3 headlight_views=2 test_views=6 reference_spp=256 ;;
    small) sky_views=3 light_views=2 hdr_views=2 fixed_views=1 headlight_views=1 test_views=4 reference_spp=128 ;;
    *) echo "$0: models are default or small, not '$models'" >&2; exit 2 ;;
esac

# Kind; dims, type and seed of the second volume of it, as small as most scans and grown from another seed; transfer functions; the light of its
# -light views.
kinds=(
    "head         128x160x168 i16  3  auto,ct-bone,ct-soft-tissue,ct-angio   --key-azimuth 50 --key-elevation 20"
    "head-closed  200x250x110 i16  4  auto,ct-skin,ct-bone,generic           --environment 1 --key 0"
    "beetle       256x256x152 u8   5  auto,generic,ct-skin,grey              --environment 0.2 --key 1 --key-azimuth -75"
    "snake        256x256x200 u16  6  auto,ct-bone,ct-soft-tissue,generic    --environment 0.5 --key 0.5 --headlight 0.5"
    "vessels      200x200x200 u8   7  auto,ct-angio,ct-lung,generic          --shading phase --phase-g 0.4"
    "foam         96x96x96    f32  8  auto,fire,generic,spectrum             --environment 0.1 --key 1 --key-elevation 80"
    "machine      192x192x146 i16  9  auto,ct-metal,grey,shells,ct-bone      --environment 0.3 --key 1 --key-azimuth 60 --key-elevation 30"
    "skull        160x216x240 u8   10 auto,ct-bone,spectrum,generic          --key-azimuth -80 --key-elevation 15"
    "cloud        128x128x160 u8   11 auto,spectrum,shells,fire,generic      --shading phase --phase-g 0.6 --key 1.5"
    "rock         160x160x180 u16  12 auto,spectrum,ct-bone,shells           --environment 0.7 --key 0.3 --key-azimuth 30"
    "fibres       240x240x118 u16  13 auto,shells,ct-lung,generic            --environment 0.3 --key 1 --key-azimuth 120"
)

# volume KIND DIMS TYPE SEED
volume() {
    [ -f "$folder/volumes/$1.nii.gz" ] || "$clvr" dataset make "$1" --dims "$2" --type "$3" --seed "$4" -o "$folder/volumes/$1.nii.gz"
}
# pairs NAME SEED SPLIT VIEWS VOLUME TRANSFER_FUNCTIONS OPTION...
pairs() {
    local name=$1 seed=$2 split=$3 views=$4 volume=$5 variations=()
    for tf in ${6//,/ }; do variations+=(--vary-tf "$tf"); done
    shift 6
    "$clvr" pairs "$volume" -o "$folder/$name" --views "$views" --size 256x256 --noisy-spp 1,2,4,8,16 --reference-spp "$reference_spp" --zoom-range 0.9,2.2 \
        --seed "$seed" --split "$split" "${variations[@]}" "$@"
}
# sky NAME SEED KIND: the path of an HDR image
sky() {
    local image=$folder/volumes/$1.hdr
    perl "$tools/make_sky.pl" "$2" "$3" >"$image"
    echo "$image"
}
# seen KIND: what the skies shine on: the first of each kind for default, the second for small
seen() { [ "$models" = default ] && echo "demo:$1" || echo "$folder/volumes/$1.nii.gz"; }

read -ra left_out <<<"${CLVR_LEAVE_OUT:-}"
for kind in "${left_out[@]}"; do
    printf '%s\n' "${kinds[@]}" | grep -q "^$kind " || { echo "$0: CLVR_LEAVE_OUT: there is no kind '$kind'" >&2; exit 2; }
done
trained=() validated=
for k in "${!kinds[@]}"; do
    read -r kind dims type seed functions light <<<"${kinds[k]}"
    second=$folder/volumes/$kind.nii.gz
    volume "$kind" "$dims" "$type" "$seed"
    if [[ " ${left_out[*]} " = *" $kind "* ]]; then
        pairs "$kind-test" "$((k + 501))" test "$test_views" "$second" "$functions"
        continue
    fi
    pairs "$kind-sky" "$((k + 1))" train "$sky_views" "$(seen "$kind")" "$functions"
    # shellcheck disable=SC2086 # the light is several words
    pairs "$kind-light" "$((k + 101))" train "$light_views" "$second" "$functions" $light
    pairs "$kind-hdr" "$((k + 201))" train "$hdr_views" "$(seen "$kind")" "$functions" --environment "$(sky "sky$((k + 1))" "$((k + 1))" sky)"
    pairs "$kind-fixed" "$((k + 301))" train "$fixed_views" "$second" "$functions" --environment "$(sky "key$((k + 1))" "$((k + 1))" key)"
    pairs "$kind-headlight" "$((k + 401))" train "$headlight_views" "$second" "$functions" --environment 0.15 --key 0 --headlight 2
    validated=${validated:-$kind}
    trained+=("$folder/$kind-"{sky,light,hdr,fixed,headlight})
done
pairs "$validated-validation" 601 test "$test_views" "$(seen "$validated")" auto,generic

made=$folder
[ ${#left_out[@]} = 0 ] || made=$folder/without-$(printf '%s\n' "${left_out[@]}" | sort -u | paste -sd-)
mkdir -p "$made"
# pass MODEL EPOCHS RATE SEED OPTION...
pass() {
    local model=$made/$1.safetensors epochs=$2 rate=$3 seed=$4
    shift 4
    [ ! -f "${model%.safetensors}.checkpoint" ] || set -- "$@" --resume
    "$clvr" train "${trained[@]}" --validate "$folder/$validated-validation" -o "$model" --patch 128 --batch 8 --patches-per-image 20 --epochs "$epochs" \
        --lr "$rate" --schedule cosine --seed "$seed" "$@"
}
# A coarser level and coarser codes average over more samples: 0.2 to 0.3 dB more at 1 sample per pixel than 4:4,8:8,16:16.
# two_passes MODEL OPTION...: the second one with squared errors
two_passes() {
    local model=$1
    shift
    pass "$model-first" 24 1e-3 0 --levels 4:8,8:16,16:16,32:32 "$@"
    pass "$model" 16 5e-4 1 --init "$made/$model-first.safetensors" --loss shifted-gamma-l2
}
if [ "$models" = default ]; then
    two_passes features # for frames without light, as clvr wrote them before
    pass default 18 5e-4 3 --init "$made/features.safetensors" --control-variate --loss shifted-gamma-l2
else
    # Other renderers' files do not say the samples per pixel and hold no opacity free of noise.
    two_passes color --channels R,G,B --no-opacity-weight
    two_passes color-albedo-normal --channels R,G,B,albedo.R,albedo.G,albedo.B,normal.X,normal.Y,normal.Z --no-opacity-weight
fi
