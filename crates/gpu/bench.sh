#!/usr/bin/env bash
# The breaking dam in space in f32 and in f64, by CUDA where there is a card of NVIDIA and then by Vulkan: a line as soon as it is measured,
# and all within eight minutes. crates/gpu/bench.sh [PARTICLES ...]; 1000000 4000000 if not given.
# What is to be run elsewhere is compiled beforehand by crates/gpu/bench.sh compile [PARTICLES ...]: the program, and its kernels for the
# architecture that ARCHITECTURE names (sm_90) where there is NVRTC. BENCH names the program if it is not where cargo has put it.
set -u
cd "$(dirname "$0")/../.."
target=${CARGO_TARGET_DIR:-target}
bench=${BENCH:-$target/release/examples/throughput}
export MESHFREE_CUBINS=${MESHFREE_CUBINS:-$target/cubins}
mkdir -p "$MESHFREE_CUBINS"
build() { cargo build --release -p meshfree-gpu --features cuda --example throughput || exit 1; }
if [ "${1:-}" = compile ]; then
    shift
    build
    [ $# -gt 0 ] || set -- 1000000 4000000
    for count in "$@"; do
        for scalar in f32 f64; do
            "$bench" "$scalar" "$count" "${ARCHITECTURE:-sm_90}" || echo "$scalar, $count particles: no kernels"
        done
    done
    exit
fi
[ -x "$bench" ] || build
[ $# -gt 0 ] || set -- 1000000 4000000
end=$((SECONDS + 460))
measure() {
    local left=$((end - SECONDS))
    if [ "$left" -lt 10 ]; then
        echo "$1, $2 particles: no time left"
        return
    fi
    timeout "$left" "$bench" "$1" "$2" $((left / 4)) "$3" || echo "$1, $2 particles by $3: ended with $?"
}
vulkan=("$@")
if "$bench" list | grep -q '"CUDA '; then
    for count in "$@"; do
        measure f32 "$count" cuda
        measure f64 "$count" cuda
    done
    vulkan=("$1")
fi
for count in "${vulkan[@]}"; do
    measure f32 "$count" vulkan
    measure f64 "$count" vulkan
done
