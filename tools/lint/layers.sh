#!/bin/bash
# Refuses includes across layers (host/README.md, "Who may include whom"). Usage: layers.sh ROOT
set -euo pipefail
cd "$1"
status=0
complain() { [ -z "$2" ] || { printf '%s:\n%s\n' "$1" "$2"; status=1; }; }

# only FOLDER PREFIX...: quoted includes in FOLDER start with one of the prefixes (paths from the root; in kernels/, from there).
only() {
    local folder=$1 allowed
    shift
    allowed=$(IFS='|'; echo "$*")
    [ ! -d "$folder" ] || complain "$folder may include $* only" \
        "$(grep -rnP '^\s*#\s*include\s*"(?!('"$allowed"'))' "$folder" || true)"
}
# nowhere_but FILES PATTERN: the pattern stands in those files (an extended regular expression over paths) and nowhere else in the product.
nowhere_but() { complain "only in $1" "$(grep -rnE "$2" runtime host | grep -vE "^($1):" || true)"; }

only runtime runtime/ kernels/shared/
only runtime/system runtime/error.hpp runtime/system/
only runtime/drivers runtime/error.hpp runtime/system/ runtime/drivers/
only runtime/tune runtime/error.hpp runtime/system/ runtime/drivers/ runtime/tune/
only runtime/opencl runtime/error.hpp runtime/system/ runtime/drivers/ runtime/tune/ runtime/opencl/
only runtime/trust runtime/error.hpp runtime/system/ runtime/drivers/ runtime/opencl/ runtime/trust/ kernels/shared/
only runtime/choose runtime/error.hpp runtime/system/ runtime/drivers/ runtime/tune/ runtime/opencl/ runtime/trust/ runtime/choose/
only runtime/schedule runtime/error.hpp runtime/system/ runtime/drivers/ runtime/opencl/ runtime/schedule/
only host/volume runtime/ host/volume/ kernels/shared/
only host/appearance runtime/ host/volume/ host/frame/ host/appearance/ kernels/shared/
only host/phantom runtime/ host/volume/ host/phantom/ kernels/shared/
only host/frame runtime/ host/frame/
only host/render runtime/ host/volume/ host/appearance/ host/frame/ host/denoise/ host/render/ kernels/shared/
only host/live runtime/ host/volume/ host/appearance/ host/frame/ host/render/ host/denoise/ host/live/
only host/denoise runtime/ host/frame/ host/denoise/ kernels/shared/
only host/io runtime/ host/volume/ host/appearance/ host/frame/ host/render/ host/denoise/ host/io/ kernels/shared/
only host/view runtime/ host/volume/ host/appearance/ host/frame/ host/render/ host/live/ host/io/ host/view/
only host/pairs runtime/ host/volume/ host/appearance/ host/frame/ host/render/ host/io/ host/pairs/
only host/train runtime/ host/frame/ host/denoise/ host/io/ host/pairs/ host/train/ kernels/shared/
only host/eval runtime/ host/frame/ host/denoise/ host/io/ host/pairs/ host/train/ host/eval/
only host/dataset runtime/ host/dataset/
only host/experiment runtime/ host/volume/ host/appearance/ host/phantom/ host/frame/ host/render/ host/denoise/ host/io/ host/pairs/ host/train/ host/eval/ host/dataset/ host/experiment/
only host/selftest runtime/ host/volume/ host/appearance/ host/phantom/ host/frame/ host/render/ host/denoise/ host/train/ host/selftest/ kernels/shared/
only host/cli runtime/ host/ kernels/shared/
only kernels/shared shared/
only kernels/lib shared/ lib/
only kernels/render shared/ lib/
only kernels/volume shared/ lib/
only kernels/denoise shared/ lib/
only kernels/train shared/ lib/
only kernels/selftest shared/ lib/
only kernels/probe shared/ lib/ trust_operations.h

nowhere_but 'runtime/drivers/opencl\.hpp' '#\s*include\s*<CL/(cl|opencl)'
nowhere_but 'host/io/[a-z0-9_/]*\.cpp' '#\s*include\s*[<"](ImfF?|png\.h|zlib\.h|minizip|libdeflate|bzlib|lz4|turbojpeg|hdf5|pugixml|tiffio|gdcm)'
nowhere_but 'runtime/system/parallel\.cpp' '#\s*include\s*<tbb'
nowhere_but 'host/dataset/download\.cpp' '#\s*include\s*<curl'
nowhere_but 'host/view/server\.cpp|host/view/beast/[a-z_]*\.hpp' '#\s*include\s*(<boost|"host/view/beast)'
nowhere_but 'host/train/matrix_layers\.cpp' '#\s*include\s*<clblast'
complain "clocks that jump have no place in the product: use steady_clock" "$(grep -rnE 'system_clock|high_resolution_clock|gettimeofday' runtime host || true)"
complain "the runtime knows no volume, no image, no network" "$(grep -rniE 'volume|brick|voxel|guide|denoise' runtime || true)"
exit $status
