#!/usr/bin/env bash
# A GPU in one command: what it computes, how fast, against what it could do at most. Needs the program, its scenes, a Vulkan
# loader with the GPU's driver, bash and coreutils; no Rust, no network.
#
#   benches/gpu-check.sh BINARY OUT
#
# Writes OUT/page.md, one page with a row a check, and beside it what every row was read from. Each row stands alone: one that
# fails is reported and the others go on. Exit code 0 if all rows passed, 1 if not. Variables, all optional:
#
#   SCENES    folder of the scenes; default: scenes beside the folder of this script
#   BUDGET    seconds for everything; default 340. A row that has no time left is reported as not run
#   SMALL=1   small meshes and short runs: tries the script itself, on a software adapter too (BUDGET is then 1500)
set -uo pipefail

[[ $# -eq 2 ]] || { echo "usage: $0 BINARY OUT" >&2; exit 2; }
binary=$(realpath "$1") || exit 2
[[ -x $binary ]] || { echo "$0: $1 is no program" >&2; exit 2; }
mkdir -p "$2" || exit 2
out=$(realpath "$2")
scenes=${SCENES:-$(dirname "$(realpath "$0")")/../scenes}
small=${SMALL:-}
budget=${BUDGET:-$([[ -n $small ]] && echo 1500 || echo 340)}
rows=$out/rows
: >"$rows"
failed=0 passed=0

left() { echo $((budget - SECONDS)); }

# row CHECK MEASURED LIMIT SHARE ERROR VERDICT: verdicts that do not begin with "passed" or "-" count as failures.
row() {
    printf '| %s | %s | %s | %s | %s | %s |\n' "$@" | tee -a "$rows" >&2
    case $6 in passed*) passed=$((passed + 1)) ;; -*) ;; *) failed=$((failed + 1)) ;; esac
}

# try SECONDS LOG ARGUMENT...: the program within its time and what is left of the budget. 124: no time.
try() {
    local most=$1 log=$2 all
    shift 2
    all=$(left)
    [[ $all -ge 3 ]] || { echo "no time left" >"$log.err"; return 124; }
    [[ $most -lt $all ]] || most=$all
    timeout -k 5 "$most" "$binary" "$@" >"$log" 2>"$log.err"
}

# why STATUS LOG: in a few words, for a cell.
why() {
    local text
    [[ $1 -eq 124 || $1 -eq 137 ]] && { echo "failed: out of time"; return; }
    text=$(tail -n 1 "$2.err")
    text=${text//|//}
    echo "failed ($1): ${text:0:160}"
}

# whole NUMBER DIGITS: NUMBER (1.234e6, 0.57, 12) times 10^DIGITS, cut to a whole number: bash counts in whole numbers only.
whole() {
    local number=$1 digits=$2 exponent=0 sign= before after
    [[ $number == -* ]] && sign=- number=${number#-}
    [[ $number == *[eE]* ]] && exponent=${number#*[eE]} number=${number%%[eE]*}
    [[ $number =~ ^[0-9]+(\.[0-9]+)?$ && $exponent =~ ^[+-]?[0-9]+$ ]] || { echo 0; return 1; }
    before=${number%%.*} after=
    [[ $number == *.* ]] && after=${number#*.}
    exponent=$((${exponent#+} + digits))
    while [[ $exponent -gt 0 ]]; do
        before+=${after:0:1}
        [[ -n $after ]] && after=${after:1} || before+=0
        exponent=$((exponent - 1))
    done
    while [[ $exponent -lt 0 ]]; do
        before=0$before
        before=${before:0:${#before}-1}
        exponent=$((exponent + 1))
    done
    echo "$sign$((10#${before:-0}))"
}

# json KEY FILE: the first value of a key in pretty-printed JSON.
json() {
    local line
    while IFS= read -r line; do
        [[ $line =~ ^[[:space:]]*\"$1\":\ \"?([^\",]*)\"?,?$ ]] && { echo "${BASH_REMATCH[1]}"; return; }
    done <"$2"
    return 1
}

# last_json KEY FILE: the last one.
last_json() {
    local line found=
    while IFS= read -r line; do
        [[ $line =~ ^[[:space:]]*\"$1\":\ \"?([^\",]*)\"?,?$ ]] && found=${BASH_REMATCH[1]}
    done <"$2"
    [[ -n $found ]] && echo "$found"
}

# ---- adapters -------------------------------------------------------------------------------------------------------------
adapter=unknown driver=unknown kind=unknown doubles=
adapters() {
    local log=$out/adapters.txt status=0 line
    try 60 "$log" adapters || status=$?
    if [[ $status -ne 0 ]]; then
        row "adapters" "" "" "" "" "$(why $status "$log")"
        return
    fi
    # The first that can be used is the one that is taken.
    while IFS= read -r line; do
        case $line in
        *"  adapter "*) adapter=${line#*adapter } adapter=${adapter#"${adapter%%[! ]*}"} ;;
        *"  driver "*) driver=${line#*driver } driver=${driver#"${driver%%[! ]*}"} ;;
        *"  double precision "*) [[ $line == *yes ]] && doubles=yes ;;
        *"  usable "*) [[ $line == *yes ]] && break ;;
        esac
    done <"$log"
    kind=gpu
    [[ $adapter == *software* ]] && kind=software
    row "adapter" "$adapter" "driver $driver" "" "" passed
}

# ---- parity ---------------------------------------------------------------------------------------------------------------
parity() {
    local log=$out/parity.md status=0 line title held verdict
    try "$([[ -n $small ]] && echo 900 || echo 90)" "$log" report parity --out - || status=$?
    if [[ $status -ne 0 && $status -ne 5 ]]; then
        row "parity with the CPU's f64" "" "" "" "" "$(why $status "$log")"
        return
    fi
    # The summary: | [title](#name) | 4 of 4 | yes | .. |
    while IFS= read -r line; do
        [[ $line =~ ^\|\ \[(.*)\]\(#[a-z-]+\)\ \|\ ([^|]*)\ \|\ ([^|]*)\ \| ]] || continue
        title=${BASH_REMATCH[1]} held=${BASH_REMATCH[2]} verdict=${BASH_REMATCH[3]}
        [[ $verdict == yes ]] && verdict=passed || verdict="failed: parity.md"
        row "parity: $title" "$held claims" "all" "" "in parity.md" "$verdict"
    done <"$log"
}

# ---- speed ----------------------------------------------------------------------------------------------------------------
# judged AIM RATE: what a real GPU's rate is to an aim (updates a second, in whole thousands).
judged() {
    [[ $kind == software ]] && { echo "passed; a software adapter's speed is not judged"; return; }
    [[ $2 -ge $1 ]] && echo "passed" || echo "below the aim"
}

# bench NAME SECONDS ENGINE ELEMENT SIZE COPIES AIM WANTED: one row of `hexroll bench`. AIM: updates a second that must be reached,
# in millions, or "us=N", microseconds a step that it may take at most; empty: none. WANTED: words for the page.
bench() {
    local name=$1 most=$2 engine=$3 element=$4 size=$5 copies=$6 aim=$7 wanted=$8
    local log status=0 line cells verdict rate=0 us
    log=$out/bench-$engine-$element-$size-$copies.md
    try "$most" "$log" bench --engines "$engine" --elements "$element" --sizes "$size" --copies "$copies" \
        --seconds "$seconds" --json "${log%.md}.json" || status=$?
    if [[ ! -s $log || ( $status -ne 0 && $status -ne 5 ) ]]; then
        row "$name" "" "$wanted" "" "" "$(why $status "$log")"
        return
    fi
    while IFS= read -r line; do
        [[ $line == "| $engine"* ]] || continue
        IFS='|' read -ra cells <<<"$line"
        cells=("${cells[@]# }")
        cells=("${cells[@]% }")
        # 1 engine, 2 element, 3 elements, 7 median us, 9 updates/s, 12 floor us, 13 fraction, 14 bound by, 16 error
        [[ ${#cells[@]} -ge 17 ]] || continue
        rate=$(whole "${cells[9]}" -6) us=$(whole "${cells[7]}" 1)
        case $aim in
        "") verdict=passed ;;
        us=*)
            verdict=$(judged 1 1)
            [[ $kind == software || $us -le $((10 * ${aim#us=})) ]] || verdict="below the aim"
            ;;
        *) verdict=$(judged "$aim" "$rate") ;;
        esac
        [[ ${cells[16]} == *failed* || $status -ne 0 ]] && verdict="failed: wrong result"
        row "$name" "${cells[9]} updates/s, ${cells[7]} us a step" \
            "floor ${cells[12]} us (${cells[14]})${wanted:+; aim $wanted}" "${cells[13]}" "${cells[16]}" "$verdict"
        return
    done <"$log"
    # Not there: doubles on an adapter without them, a mesh that does not fit.
    row "$name" "not there" "$wanted" "" "" "- $(tail -n 3 "$log" | head -n 1 | tr '|' '/')"
}

speed() {
    local large=450560 many=1000 size
    seconds=0.25
    [[ -n $small ]] && large=7040 many=8 seconds=0.1
    bench "q1p0 f32, $large elements, contact" 60 gpu-f32 q1p0 $large 1 3000 "3e9 updates/s at least, 6e9 and 0.4 of the floor aimed at"
    bench "uniform-gradient f32, $large elements" 40 gpu-f32 uniform-gradient $large 1 10000 "1e10 updates/s"
    if [[ -n $doubles ]]; then
        bench "q1p0 f64, $large elements" 60 gpu-f64 q1p0 $large 1 "" "half of f32"
    else
        row "q1p0 f64, $large elements" "not there" "" "" "" "- the adapter has no double precision"
    fi
    bench "q1p0 f32, 880 elements" 20 gpu-f32 q1p0 880 1 us=12 "12 us a step at most (one small wheel gains nothing over a CPU core)"
    bench "q1p0 f32, $many wheels of 880 elements at once" 40 gpu-f32 q1p0 880 $many 8000 "8e9 updates/s"
    bench "q1p0 f32+, $large elements" 60 gpu-f32+ q1p0 $large 1 "" ""
    for size in 7040 56320; do
        [[ -n $small && $size -gt 7040 ]] || bench "q1p0 f32, $size elements" 20 gpu-f32 q1p0 $size 1 "" ""
    done
}

# ---- the paper's scenes ---------------------------------------------------------------------------------------------------
# nearly A B: |A - B| over |B| in hundredths of a per cent, of numbers of newtons.
nearly() {
    local a b d
    a=$(whole "$1" 3) b=$(whole "$2" 3)
    d=$((a - b))
    [[ $b -ne 0 ]] || { echo 999999; return; }
    echo $((10000 * ${d#-} / ${b#-}))
}

# hundredths N: 123 -> 1.23
hundredths() { printf '%d.%02d' $(($1 / 100)) $(($1 % 100)); }

short=()
[[ -n $small ]] && short=(--set 'stage.1.duration=4 ms' --set 'output.snapshots=2 ms')

# rolled SCENE: on the GPU with pictures, and on the CPU in f64; mean forces of the last stage side by side.
rolled() {
    local name=$1 status=0 folder=$out/$1 pictures worst=0 off key gpu cpu line=
    try "$([[ -n $small ]] && echo 400 || echo 40)" "$out/$name-gpu.txt" run "$scenes/$name.toml" --engine gpu --precision f32 \
        "${short[@]}" --out "$folder-gpu" || status=$?
    if [[ $status -ne 0 ]]; then
        row "$name" "" "" "" "" "$(why $status "$out/$name-gpu.txt")"
        return
    fi
    pictures=("$folder-gpu"/*.png)
    [[ -s ${pictures[0]} ]] || { row "$name" "" "" "" "" "failed: no picture"; return; }
    try 60 "$out/$name-cpu.txt" run "$scenes/$name.toml" --engine cpu --precision f64 "${short[@]}" \
        --set 'output.pictures=[]' --out "$folder-cpu" || status=$?
    if [[ $status -ne 0 ]]; then
        row "$name" "" "" "" "" "$(why $status "$out/$name-cpu.txt")"
        return
    fi
    for key in mean_road_fx_N mean_road_fz_N mean_rim_my_Nm; do
        gpu=$(last_json $key "$folder-gpu/summary.json") cpu=$(last_json $key "$folder-cpu/summary.json")
        off=$(nearly "$gpu" "$cpu")
        [[ $off -gt $worst ]] && worst=$off
        line+="${line:+, }$(printf '%.4g for %.4g' "$gpu" "$cpu")"
    done
    # A viscous wheel's mean forces are the CPU's to a few thousandths: contact may come a step sooner or later.
    [[ $worst -le 50 ]] && status=passed || status="failed: forces differ by more than 0.5 %"
    row "$name, ${#pictures[@]} pictures" "Fx, Fz [N], My [N m]: $line" "the CPU's in f64" "" "$(hundredths $worst) %" "$status"
}

# ---- the same bits five times ---------------------------------------------------------------------------------------------
repeated() {
    local k sum first= status=0 folder scene=lat100_straight_viscous
    for k in 1 2 3 4 5; do
        folder=$out/again-$k
        try "$([[ -n $small ]] && echo 200 || echo 20)" "$folder.txt" run "$scenes/$scene.toml" --engine gpu --precision f32 \
            --set "stage.1.duration=$([[ -n $small ]] && echo 2 || echo 20) ms" --set 'output.pictures=[]' --out "$folder" || status=$?
        [[ $status -eq 0 ]] || { row "the same bits five times" "" "" "" "" "$(why $status "$folder.txt")"; return; }
        sum=$(sha256sum <"$folder/history.csv")
        first=${first:-$sum}
        [[ $sum == "$first" ]] || { row "the same bits five times" "run $k differs" "" "" "" "failed"; return; }
    done
    row "the same bits five times" "history.csv of $scene: ${first:0:16}" "one checksum" "" "" passed
}

page() {
    {
        printf '# GPU check\n\n'
        if [[ $kind == software ]]; then
            printf '**The adapter is software: every time below is this processor'"'"'s and says nothing of a GPU.** What is computed is checked; speed is not judged.\n\n'
        fi
        printf 'Adapter: %s. Driver: %s. %s, %s processors. %s s of %s s taken%s.\n\n' "$adapter" "$driver" \
            "$("$binary" --version)" "$(nproc)" "$SECONDS" "$budget" "${small:+; small meshes and short runs}"
        printf '%s passed, %s failed or below their aims.\n\n' "$passed" "$failed"
        printf '| check | measured | limit | share of the limit | error | verdict |\n| --- | --- | --- | --- | --- | --- |\n'
        cat "$rows"
        printf '\nFloor: the least time of a step by the copy and multiply-add rates measured in the same run. Error: of positions against the'
        printf ' CPU in f64 after the same steps, over the deformation.\nWhat each row was read from lies beside this page.\n'
    } >"$out/page.md"
}

trap page EXIT
adapters
parity
speed
repeated
for name in lat100_straight_viscous lat100_slip5_viscous lat100_slip45_viscous; do
    rolled $name
done
echo "$passed passed, $failed failed; $out/page.md" >&2
[[ $failed -eq 0 ]]
