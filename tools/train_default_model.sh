#!/bin/bash
# Makes the default model again: pairs of the volumes that clvr computes, under two lights each, then the training. Usage: train_default_model.sh DIR [CLVR]
# Goes on where it was interrupted. On two cores: about an hour for the pairs, half an hour for the training.
set -euo pipefail
folder=$1
clvr=${2:-build/release/clvr}
mkdir -p "$folder"

# pairs NAME SEED SPLIT VIEWS VOLUME TRANSFER_FUNCTIONS OPTION...
pairs() {
    local name=$1 seed=$2 split=$3 views=$4 volume=$5 variations=()
    for tf in ${6//,/ }; do variations+=(--vary-tf "$tf"); done
    shift 6
    "$clvr" pairs "$volume" -o "$folder/$name" --views "$views" --size 256x256 --noisy-spp 1,2,4,8,16 --reference-spp 256 --zoom-range 0.9,2.2 \
        --seed "$seed" --split "$split" "${variations[@]}" "$@"
}

volumes=(head head-closed beetle snake vessels foam)
functions=(ct-bone,ct-soft-tissue,ct-angio ct-skin,ct-bone,generic generic,ct-skin,ct-bone ct-bone,ct-soft-tissue,generic ct-angio,ct-lung,generic
    fire,generic,diverging)
lights=("--key-azimuth 50 --key-elevation 20" "--environment 1 --key 0" "--environment 0.2 --key 1 --key-azimuth -75" "--environment 0.5 --key 0.5 --headlight 0.5"
    "--shading phase --phase-g 0.4" "--environment 0.1 --key 1 --key-elevation 80")
for k in "${!volumes[@]}"; do
    pairs "${volumes[k]}-sky" "$((k + 1))" train 12 "demo:${volumes[k]}" "${functions[k]}"
done
for k in "${!volumes[@]}"; do
    # shellcheck disable=SC2086 # the light is several words
    pairs "${volumes[k]}-light" "$((k + 11))" train 12 "demo:${volumes[k]}" "${functions[k]}" ${lights[k]}
done
pairs validation-head 21 test 4 demo:head ct-soft-tissue,ct-bone
pairs validation-beetle 22 test 4 demo:beetle ct-skin,generic

trained=()
for k in "${volumes[@]}"; do trained+=("$folder/$k-sky" "$folder/$k-light"); done
resume=()
[ ! -f "$folder/default.checkpoint" ] || resume=(--resume)
"$clvr" train "${trained[@]}" --validate "$folder/validation-head" -o "$folder/default.safetensors" \
    --channels R,G,B,albedo.R,albedo.G,albedo.B,normal.X,normal.Y,normal.Z,depth.Z,opacity.A,depth.deviation,depth.half,noise \
    --patch 128 --batch 8 --patches-per-image 20 --epochs 20 --lr 1e-3 --schedule cosine "${resume[@]}"
