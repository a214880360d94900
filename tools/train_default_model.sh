#!/bin/bash
# Makes the models inside clvr again: volumes that clvr computes, views of each in three kinds of light, then the training.
# Usage: train_default_model.sh DIR [CLVR [default|small]]
#   default   the model that reads all channels of clvr's frames, of 24 views a volume
#   small     those for other renderers' pictures, color and color-albedo-normal, of 7 views a volume with references of half the samples
# Goes on where it was interrupted. On two cores: about 2 hours for the pairs of default, 20 minutes for its training; on a large GPU minutes.
set -euo pipefail
folder=$1
clvr=${2:-build/release/clvr}
models=${3:-default}
mkdir -p "$folder/volumes"
case $models in
    default) sky_views=12 light_views=6 hdr_views=6 test_views=6 reference_spp=256 ;;
    small) sky_views=3 light_views=2 hdr_views=2 test_views=4 reference_spp=128 ;;
    *) echo "$0: models are default or small, not '$models'" >&2; exit 2 ;;
esac

# volume NAME COMPUTED DIMS TYPE SEED: the second of each kind, as small as most scans and grown from another seed
volume() {
    [ -f "$folder/volumes/$1.nii.gz" ] || "$clvr" dataset make "$2" --dims "$3" --type "$4" --seed "$5" -o "$folder/volumes/$1.nii.gz"
}
# pairs NAME SEED SPLIT VIEWS VOLUME TRANSFER_FUNCTIONS OPTION...
pairs() {
    local name=$1 seed=$2 split=$3 views=$4 volume=$5 variations=()
    for tf in ${6//,/ }; do variations+=(--vary-tf "$tf"); done
    shift 6
    "$clvr" pairs "$volume" -o "$folder/$name" --views "$views" --size 256x256 --noisy-spp 1,2,4,8,16 --reference-spp "$reference_spp" --zoom-range 0.9,2.2 \
        --seed "$seed" --split "$split" "${variations[@]}" "$@"
}

volumes=(head head-closed beetle snake vessels foam)
shapes=("128x160x168 i16 3" "200x250x110 i16 4" "256x256x152 u8 5" "256x256x200 u16 6" "200x200x200 u8 7" "96x96x96 f32 8") # dims, type, seed
functions=(auto,ct-bone,ct-soft-tissue,ct-angio auto,ct-skin,ct-bone,generic auto,generic,ct-skin,grey auto,ct-bone,ct-soft-tissue,generic
    auto,ct-angio,ct-lung,generic auto,fire,generic,diverging)
lights=("--key-azimuth 50 --key-elevation 20" "--environment 1 --key 0" "--environment 0.2 --key 1 --key-azimuth -75" "--environment 0.5 --key 0.5 --headlight 0.5"
    "--shading phase --phase-g 0.4" "--environment 0.1 --key 1 --key-elevation 80")
for k in "${!volumes[@]}"; do
    read -r dims type seed <<<"${shapes[k]}"
    volume "${volumes[k]}" "${volumes[k]}" "$dims" "$type" "$seed"
done
# seen NAME: what the sky and the HDR sky shine on: the first of each kind for default, the second for small
seen() { [ "$models" = default ] && echo "demo:$1" || echo "$folder/volumes/$1.nii.gz"; }
for k in "${!volumes[@]}"; do
    v=${volumes[k]}
    pairs "$v-sky" "$((k + 1))" train "$sky_views" "$(seen "$v")" "${functions[k]}"
    # shellcheck disable=SC2086 # the light is several words
    pairs "$v-light" "$((k + 11))" train "$light_views" "$folder/volumes/$v.nii.gz" "${functions[k]}" ${lights[k]}
    sky=$folder/volumes/sky$((k + 1)).hdr
    perl "$(dirname "$0")/make_sky.pl" "$((k + 1))" >"$sky"
    pairs "$v-hdr" "$((k + 31))" train "$hdr_views" "$(seen "$v")" "${functions[k]}" --environment "$sky"
done
pairs validation 21 test "$test_views" "$(seen head)" auto,ct-skin

trained=()
for k in "${volumes[@]}"; do trained+=("$folder/$k-sky" "$folder/$k-light" "$folder/$k-hdr"); done
# pass MODEL EPOCHS RATE SEED OPTION...
pass() {
    local model=$folder/$1.safetensors epochs=$2 rate=$3 seed=$4
    shift 4
    [ ! -f "${model%.safetensors}.checkpoint" ] || set -- "$@" --resume
    "$clvr" train "${trained[@]}" --validate "$folder/validation" -o "$model" --patch 128 --batch 8 --patches-per-image 20 --epochs "$epochs" \
        --lr "$rate" --schedule cosine --seed "$seed" "$@"
}
# A coarse level averages more of few samples, and coarser codes do: 0.2 to 0.3 dB more at 1 sample per pixel than 4:4,8:8,16:16.
# two_passes MODEL OPTION...: the second one with squared errors
two_passes() {
    local model=$1
    shift
    pass "$model-first" 24 1e-3 0 --levels 4:8,8:16,16:16,32:32 "$@"
    pass "$model" 16 5e-4 1 --init "$folder/$model-first.safetensors" --loss shifted-gamma-l2
}
if [ "$models" = default ]; then
    two_passes default
else
    # Other renderers' files do not say the samples per pixel and hold no opacity free of noise.
    two_passes color --channels R,G,B --no-opacity-weight
    two_passes color-albedo-normal --channels R,G,B,albedo.R,albedo.G,albedo.B,normal.X,normal.Y,normal.Z --no-opacity-weight
fi
