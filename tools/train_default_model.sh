#!/bin/bash
# Makes the default model again: volumes that clvr computes, 24 views of each in three kinds of light, then the training.
# Usage: train_default_model.sh DIR [CLVR]
# Goes on where it was interrupted. On two cores: about 2 hours for the pairs, 20 minutes for the training; on a large GPU minutes.
set -euo pipefail
folder=$1
clvr=${2:-build/release/clvr}
mkdir -p "$folder/volumes"

# volume NAME COMPUTED DIMS TYPE SEED: the second of each kind, as small as most scans and grown from another seed
volume() {
    [ -f "$folder/volumes/$1.nii.gz" ] || "$clvr" dataset make "$2" --dims "$3" --type "$4" --seed "$5" -o "$folder/volumes/$1.nii.gz"
}
# pairs NAME SEED SPLIT VIEWS VOLUME TRANSFER_FUNCTIONS OPTION...
pairs() {
    local name=$1 seed=$2 split=$3 views=$4 volume=$5 variations=()
    for tf in ${6//,/ }; do variations+=(--vary-tf "$tf"); done
    shift 6
    "$clvr" pairs "$volume" -o "$folder/$name" --views "$views" --size 256x256 --noisy-spp 1,2,4,8,16 --reference-spp 256 --zoom-range 0.9,2.2 \
        --seed "$seed" --split "$split" "${variations[@]}" "$@"
}

volumes=(head head-closed beetle snake vessels foam)
shapes=("128x160x168 i16 3" "200x250x110 i16 4" "256x256x152 u8 5" "256x256x200 u16 6" "200x200x200 u8 7" "96x96x96 f32 8") # dims, type, seed
functions=(auto,ct-bone,ct-soft-tissue,ct-angio auto,ct-skin,ct-bone,generic auto,generic,ct-skin,grey auto,ct-bone,ct-soft-tissue,generic
    auto,ct-angio,ct-lung,generic auto,fire,generic,diverging)
lights=("--key-azimuth 50 --key-elevation 20" "--environment 1 --key 0" "--environment 0.2 --key 1 --key-azimuth -75" "--environment 0.5 --key 0.5 --headlight 0.5"
    "--shading phase --phase-g 0.4" "--environment 0.1 --key 1 --key-elevation 80")
for k in "${!volumes[@]}"; do
    pairs "${volumes[k]}-sky" "$((k + 1))" train 12 "demo:${volumes[k]}" "${functions[k]}"
done
for k in "${!volumes[@]}"; do
    read -r dims type seed <<<"${shapes[k]}"
    volume "${volumes[k]}" "${volumes[k]}" "$dims" "$type" "$seed"
    # shellcheck disable=SC2086 # the light is several words
    pairs "${volumes[k]}-light" "$((k + 11))" train 6 "$folder/volumes/${volumes[k]}.nii.gz" "${functions[k]}" ${lights[k]}
done
for k in "${!volumes[@]}"; do
    sky=$folder/volumes/sky$((k + 1)).hdr
    perl "$(dirname "$0")/make_sky.pl" "$((k + 1))" >"$sky"
    pairs "${volumes[k]}-hdr" "$((k + 31))" train 6 "demo:${volumes[k]}" "${functions[k]}" --environment "$sky"
done
pairs validation 21 test 6 demo:head auto,ct-skin

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
pass first 24 1e-3 0 --levels 4:8,8:16,16:16,32:32
pass default 16 5e-4 1 --init "$folder/first.safetensors" --loss shifted-gamma-l2
