# SPDX-License-Identifier: MIT
# `. tests/targets/selftest.sh` after tests/lib.sh: the scripts that judge
# targets find what they are there to find.

# Call graphs as gcc writes them: graph NODE..., with NODE = NAME:BYTES:KIND or
# CALLER>CALLEE.
graph()
{
    for word in brume_volume_open:8:static brume_begin_frame:16:static \
        brume_scene_default:8:static brume_render_rect:64:static "$@"; do
        case $word in
        *'>'*)
            printf 'edge: { sourcename: "%s" targetname: "%s" }\n' \
                "${word%%>*}" "${word#*>}"
            ;;
        *)
            name=${word%%:*} rest=${word#*:}
            printf 'node: { title: "%s" label: "%s\\n%s bytes (%s)" }\n' \
                "$name" "$name" "${rest%%:*}" "${rest#*:}"
            ;;
        esac
    done
}

# graph_gives TEXT NODE...: what stack.awk says of a graph begins so.
graph_gives()
{
    wanted=$1
    shift
    got=$(graph "$@" | awk -f tests/targets/stack.awk | head -n 1)
    case $got in "$wanted"*) ;; *) echo "got: $got"; return 1 ;; esac
}

stack_is_judged()
{
    graph_gives '64 brume_render_rect' &&
        graph_gives '128 brume_render_rect' 'brume_render_rect>memcpy' &&
        graph_gives '216 brume_begin_frame' a:200:static \
            'brume_begin_frame>a' &&
        graph_gives 'stack: a is recursive' a:8:static b:8:static \
            'brume_render_rect>a' 'a>b' 'b>a' &&
        graph_gives 'stack: a call through a pointer' \
            'brume_render_rect>__indirect_call' &&
        graph_gives 'stack: a has a frame of unknown size' a:8:dynamic
}

symbols_are_judged()
{
    bad="__aeabi_fadd __aeabi_dmul __aeabi_ui2f __adddf3 __mulsf3 __floatsidf
        __fixdfsi __extendsfdf2 expf sqrt malloc _sbrk __aeabi_uldivmod
        __aeabi_ldivmod __udivdi3 __moddi3 __udivmoddi4 __aeabi_d2iz
        __aeabi_cfcmpeq __aeabi_l2d __aeabi_drsub"
    good="memcpy __aeabi_uidiv __aeabi_uidivmod __udivsi3 __aeabi_memcpy
        brume_render_rect __clzsi2 __aeabi_lmul explain"
    for name in $bad; do
        echo "00000000 T $name" | awk -f tests/targets/symbols.awk |
            grep -q . || { echo "passed: $name"; return 1; }
    done
    for name in $good; do
        ! echo "00000000 T $name" | awk -f tests/targets/symbols.awk |
            grep . || return 1
    done
}

# A moved count, another image and a fault must fail; a missing tool skips.
results_are_judged()
{
    work=$BUILD/targets/selftest
    mkdir -p "$work/reference" "$work/t"
    echo 't cc-1 s 1000 100' >"$work/counts.txt"
    echo 's 0000abcd' >"$work/golden.txt"
    echo 't code 60' >"$work/limits.txt"
    { echo 'scene s 0000abcd 1x1 0 0'; echo 'tally s 10 5 20 2'; } \
        >"$work/reference/result.txt"
    while read -r wanted hash count begin bytes state; do
        {
            echo "scene s $hash 1x1 $count $begin"
            echo "compiler cc-1"
            echo "size $bytes 10 0 0"
            echo "state $state"
        } >"$work/t/result.txt"
        failures=$(awk -v mode=verdict -v counts="$work/counts.txt" \
            -v limits="$work/limits.txt" -v golden="$work/golden.txt" \
            -f tests/targets/judge.awk "$work/reference/result.txt" \
            "$work/t/result.txt" | grep -c ^fail) || true
        [ "$failures" = "$wanted" ] || {
            echo "$hash $count $begin $bytes $state: $failures failures"
            return 1
        }
    done <<'END'
0 0000abcd 1000 100 50 ok
0 0000abcd 1009 100 50 ok
1 0000abcd 1011 100 50 ok
1 0000abcd 989 100 50 ok
1 0000abcd 1000 102 50 ok
1 0000abce 1000 100 50 ok
1 0000abcd 0 100 50 ok
1 0000abcd 1000 100 51 ok
1 0000abcd 1000 100 50 fail
0 0000abcd 1000 100 50 skip
END
}

check "stack.awk: sums, recursion, pointers, unknown frames" stack_is_judged
check "symbols.awk: float, libm, heap, 64-bit division" symbols_are_judged
check "judge.awk: images, drift, limits, faults" results_are_judged
