/* SPDX-License-Identifier: MIT */
/*
 * The phase function of water droplets in air, by their size: Jendersie and
 * d'Eon, "An Approximate Mie Scattering Function for Fog and Cloud Rendering",
 * SIGGRAPH 2023 talks. Their fits give what the core takes: a mix of Draine's
 * function and Henyey and Greenstein's.
 */
#ifndef BRUME_HOST_DROPLET_H
#define BRUME_HOST_DROPLET_H

#define DROPLET_MIN 0.05 /* diameters, micrometres */
#define DROPLET_MAX 50.0

struct droplet {
    double g_hg;            /* of Henyey and Greenstein's part */
    double g_draine, alpha; /* of Draine's */
    double weight;          /* of Draine's part; the other has the rest */
};

/* Of droplets of `diameter` micrometres, DROPLET_MIN to DROPLET_MAX. */
struct droplet droplet_fit(double diameter);

#endif
