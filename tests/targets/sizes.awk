# SPDX-License-Identifier: MIT
# Of `size -A OBJECT...`: "CODE RODATA DATA BSS", in bytes. Unwinding tables
# and notes are left out: nothing of them need be in a device's memory.
$1 ~ /^\.text|^CODE$/ { code += $2 }
$1 ~ /^\.s?rodata|^\.data\.rel\.ro|^DATA$/ { rodata += $2; next }
$1 ~ /^\.s?data/ { data += $2 }
$1 ~ /^\.s?bss/ { bss += $2 }
END { print code + 0, rodata + 0, data + 0, bss + 0 }
