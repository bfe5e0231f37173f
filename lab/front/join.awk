# SPDX-License-Identifier: MIT
# join.awk ERROR.csv M4.csv TIME.csv: a row for each setting of the front, with
# error at frames 3 and 31, instructions of a Cortex-M4 per pixel without those
# of the frame's beginning, and host time in frames of the peer. What a table
# that is not there would have told is left empty.
BEGIN {
    FS = OFS = ","
}
FNR == 1 {
    delete at
    for (i = 1; i <= NF; i++)
        at[$i] = i
    next
}
{
    key = $at["volume"] OFS $at["setting"]
}
"rmse" in at {
    if (!(key in known)) {
        known[key] = 1
        row[++rows] = key
    }
    # A picture without noise stands still: its only frame is all of them.
    frames = $at["frame"] == 0 ? "3 31" : $at["frame"]
    for (i = split(frames, frame, " "); i > 0; i--) {
        rmse[key, frame[i]] = $at["rmse"]
        flip[key, frame[i]] = $at["flip"]
    }
}
"trace" in at {
    m4[key] = sprintf("%.1f", ($at["trace"] + $at["resolve"] + \
        $at["show"]) / $at["pixels"])
}
"peer_ms" in at {
    time[key] = sprintf("%.5f", $at["ms"] / $at["peer_ms"])
}
END {
    print "volume", "setting", "format", "lookup", "light", "step", "noise", \
        "temporal", "spatial", "rays", "rmse3", "flip3", "rmse31", "flip31", \
        "m4", "time"
    for (i = 1; i <= rows; i++) {
        key = row[i]
        parts = key
        sub(/.*,/, "", parts)
        gsub(/-/, OFS, parts)
        print key, parts, rmse[key, 3], flip[key, 3], rmse[key, 31], \
            flip[key, 31], m4[key], time[key]
    }
}
