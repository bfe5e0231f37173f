# SPDX-License-Identifier: MIT
# stack.awk FILE.ci...: the deepest stack of the core's functions, from gcc's
# -fcallgraph-info=su: "BYTES ROOT". Fails on recursion, on calls through
# pointers, on frames of unknown size and when there is nothing to read.
# Functions outside the core (memcpy, division) count as `outside` bytes.
BEGIN {
    outside = 64
    roots = "brume_volume_open brume_scene_default brume_begin_frame " \
        "brume_render_rect"
    # where they are compiled in
    more = "brume_show_rect brume_trace_rect brume_resolve_rect " \
        "brume_phase_build brume_cache_rows brume_shadow_begin " \
        "brume_shadow_rect brume_shadow_at"
}
function fail(text) {
    print "stack: " text
    failed = 1
}
/^node:/ {
    split($0, part, "\"")
    name = part[2]
    if (match(part[4], /[0-9]+ bytes \([a-z,]*\)/)) {
        words = substr(part[4], RSTART, RLENGTH)
        bytes[name] = words + 0
        if (words ~ /\(dynamic\)/)
            fail(name " has a frame of unknown size")
    }
}
/^edge:/ {
    split($0, part, "\"")
    calls[part[2]] = calls[part[2]] "\n" part[4]
}
function depth(name, list, n, i, below, deepest) {
    if (name == "__indirect_call")
        fail("a call through a pointer")
    if (!(name in bytes))
        return outside
    if (name in known)
        return known[name]
    if (name in open) {
        fail(name " is recursive")
        return 0
    }
    open[name] = 1
    n = split(substr(calls[name], 2), list, "\n")
    for (i = 1; i <= n; i++) {
        below = depth(list[i])
        deepest = below > deepest ? below : deepest
    }
    delete open[name]
    return known[name] = bytes[name] + deepest
}
END {
    n = split(roots, root, " ")
    for (i = split(more, other, " "); i > 0; i--)
        if (other[i] in bytes)
            root[++n] = other[i]
    for (i = 1; i <= n; i++) {
        if (!(root[i] in bytes))
            fail(root[i] " is not there")
        else if (depth(root[i]) > worst) {
            worst = depth(root[i])
            where = root[i]
        }
    }
    if (!failed)
        print worst, where
    exit failed
}
