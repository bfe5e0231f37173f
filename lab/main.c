/* SPDX-License-Identifier: MIT */
#include "lab.h"

int main(int argc, char **argv)
{
    static struct lab_options options;
    char err[LAB_ERROR] = "";
    int status = lab_read_options(&options, argc, argv);
    if (status >= 0)
        return status;
    status = options.is_picture ? lab_picture(&options, err, sizeof err)
             : options.is_pack  ? lab_pack(&options, err, sizeof err)
                                : lab_sequence(&options, err, sizeof err);
    if (status != 0)
        fprintf(stderr, "brume-lab: %s\n", err);
    return status;
}
