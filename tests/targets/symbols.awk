# SPDX-License-Identifier: MIT
# Of `nm FIRMWARE`: a line `forbidden NAME` for floating point, libm, the heap
# and 64-bit division, none of which a renderer in integers may bring along.
{ name = $NF }
name ~ /^__aeabi_(c?[fd]|[iu]?l2[fd]|u?i2[fd]|u?l2[fd]|h2f)/ ||
name ~ /^__(add|sub|mul|div|neg|cmp|eq|ne|lt|le|gt|ge|unord)[sdt]f[23]$/ ||
name ~ /^__(fix|fixuns|float|floatun|extend|trunc)[sdth][fi]/ ||
name ~ /^(sin|cos|tan|exp|log|pow|sqrt|floor|ceil|fmod)f?$/ ||
name ~ /^_?(malloc|free|calloc|realloc|sbrk|malloc_r|free_r|sbrk_r)$/ ||
name ~ /^__aeabi_u?ldivmod$|^__u?(div|mod|divmod)di[34]$/ {
    print "forbidden", name
}
