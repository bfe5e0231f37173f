/* SPDX-License-Identifier: MIT */
/*
 * Subcommands of `brume`. argv[1] on are the arguments. They return the exit
 * status: 0, 1 when the work fails, 2 on bad usage or input.
 */
#ifndef BRUME_HOST_COMMANDS_H
#define BRUME_HOST_COMMANDS_H

int render_main(int argc, char **argv);
int info_main(int argc, char **argv);
int shadow_main(int argc, char **argv);
int surface_main(int argc, char **argv);

#endif
