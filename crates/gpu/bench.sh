#!/usr/bin/env bash
# The breaking dam in space on the fastest adapter, in f32 and in f64: a line as soon as it is measured, and all within eight minutes.
# crates/gpu/bench.sh [PARTICLES ...]; 1000000 4000000 if not given. What is to be run elsewhere is compiled beforehand by
# cargo build --release -p meshfree-gpu --example throughput, and named by BENCH if it is not where cargo has put it.
set -u
cd "$(dirname "$0")/../.."
bench=${BENCH:-${CARGO_TARGET_DIR:-target}/release/examples/throughput}
[ -x "$bench" ] || cargo build --release -p meshfree-gpu --example throughput || exit 1
[ $# -gt 0 ] || set -- 1000000 4000000
end=$((SECONDS + 460))
for count in "$@"; do
    for scalar in f32 f64; do
        left=$((end - SECONDS))
        if [ "$left" -lt 10 ]; then
            echo "$scalar, $count particles: no time left"
            continue
        fi
        timeout "$left" "$bench" "$scalar" "$count" $((left / 4)) || echo "$scalar, $count particles: ended with $?"
    done
done
