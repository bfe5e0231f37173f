/* SPDX-License-Identifier: MIT */
/* The command `brume`: picks the subcommand. */
#include <stdio.h>
#include <string.h>

#include "brume.h"
#include "commands.h"
#include "compare.h"

static const char k_help[] =
    "usage: brume COMMAND ...\n"
    "\n"
    "  render   draw a baked volume, as a picture or a sequence\n"
    "  shadow   draw the shadow that a baked volume throws\n"
    "  surface  draw solid things for a volume's scene: depth, sun map\n"
    "  info     say what a baked volume holds\n"
    "  compare  measure how two pictures differ\n"
    "\n"
    "`brume COMMAND --help` tells more. Volumes are baked by brume-bake.\n";

int main(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "--help";
    if (strcmp(name, "render") == 0)
        return render_main(argc - 1, argv + 1);
    if (strcmp(name, "shadow") == 0)
        return shadow_main(argc - 1, argv + 1);
    if (strcmp(name, "surface") == 0)
        return surface_main(argc - 1, argv + 1);
    if (strcmp(name, "info") == 0)
        return info_main(argc - 1, argv + 1);
    if (strcmp(name, "compare") == 0)
        return compare_main(argc - 1, argv + 1);
    if (strcmp(name, "--version") == 0) {
        printf("brume %d.%d.%d\n", BRUME_VERSION_MAJOR, BRUME_VERSION_MINOR,
               BRUME_VERSION_PATCH);
        return 0;
    }
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
        fputs(k_help, argc > 1 ? stdout : stderr);
        return argc > 1 ? 0 : 2;
    }
    fprintf(stderr, "brume: no command '%s'; brume --help lists them\n", name);
    return 2;
}
