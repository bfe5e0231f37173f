/* SPDX-License-Identifier: MIT */
/* The command `brume compare`: metrics.h for files. */
#ifndef BRUME_HOST_COMPARE_H
#define BRUME_HOST_COMPARE_H

/* argv[1] on are the arguments, argv[0] is not looked at. Prints the metrics to
 * stdout, one name=value a line, errors to stderr.
 *
 * Returns the exit status: 0; 1 when the RMSE is above --max-rmse; 2 on bad
 * usage, files that cannot be read or written, and differing sizes. */
int compare_main(int argc, char **argv);

#endif
