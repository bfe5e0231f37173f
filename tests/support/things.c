/* SPDX-License-Identifier: MIT */
#include "things.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset_builder.h"

char things_err[400];
struct volume_file things_volume;
struct brume_scene things_scene;

void things_point(int32_t out[3], double x, double y, double z)
{
    const double v[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        out[i] = (int32_t)(v[i] * 65536);
}

void things_begin(void)
{
    static const struct density_box k_box = {{2, 2, 2}, {6, 6, 6}, 65280};
    struct asset_spec spec =
        asset_spec_of(1, 1, 1, BRUME_U8, density_in_box, &k_box);
    size_t size;
    things_volume.data = asset_build(&spec, &size);
    things_volume.voxel_size = 1;
    for (int i = 0; i < 3; i++)
        things_volume.world_from_index[5 * i] = 1;
    if (brume_volume_open(&things_volume.volume, things_volume.data, size, 0) !=
        BRUME_OK)
        abort();
    brume_scene_default(&things_scene, &things_volume.volume);
    things_scene.width = 160;
    things_scene.height = 120;
    things_scene.fov = 50 << 16;
    things_point(things_scene.eye, 0, 10, -40);
    things_point(things_scene.target, 0, 8, 0);
    things_point(things_scene.sun, 0, 1, 0);
}

/// Meshes ///

void things_obj(struct mesh *mesh, const char *text)
{
    if (mesh_parse_obj(mesh, "test", text, strlen(text), &things_volume, 0,
                       things_err, sizeof things_err) != 0) {
        fprintf(stderr, "%s\n", things_err);
        exit(1);
    }
}

/* A box from a to b. */
void things_box(struct mesh *mesh, const double a[3], const double b[3])
{
    char text[1024];
    int n = 0;
    for (int i = 0; i < 8; i++)
        n += snprintf(text + n, sizeof text - (size_t)n,
                      "v %.17g %.17g %.17g\n", (i & 1 ? b : a)[0],
                      (i & 2 ? b : a)[1], (i & 4 ? b : a)[2]);
    snprintf(text + n, sizeof text - (size_t)n,
             "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4\n"
             "f -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3\n");
    things_obj(mesh, text);
}

/* A sphere of n rings and 2 n sectors. */
void things_sphere(struct mesh *mesh, const double centre[3], double radius,
                   int n)
{
    const double pi = 3.14159265358979323846;
    size_t room = (size_t)n * (size_t)n * 2 * 150 + 1000, at = 0;
    char *text = malloc(room);
    for (int i = 0; i <= n; i++)
        for (int j = 0; j < 2 * n; j++)
            at += (size_t)snprintf(
                text + at, room - at, "v %.15g %.15g %.15g\n",
                centre[0] + radius * sin(pi * i / n) * cos(pi * j / n),
                centre[1] + radius * cos(pi * i / n),
                centre[2] + radius * sin(pi * i / n) * sin(pi * j / n));
    for (int i = 0; i < n; i++)
        for (int j = 0; j < 2 * n; j++) {
            int a = i * 2 * n + j + 1, b = i * 2 * n + (j + 1) % (2 * n) + 1;
            at += (size_t)snprintf(text + at, room - at, "f %d %d %d %d\n", a,
                                   b, b + 2 * n, a + 2 * n);
        }
    things_obj(mesh, text);
    free(text);
}

/* A surface over a mesh; end with done(). */
void things_surface(struct surface *s, const struct mesh *mesh)
{
    memset(s, 0, sizeof *s);
    s->mesh = mesh;
    s->file = &things_volume;
    s->caster = caster_new(mesh);
    for (int c = 0; c < 3; c++)
        s->albedo[0][c] = 0.25;
    if (surface_begin(s, &things_scene, NULL, things_err, sizeof things_err) !=
        0)
        abort();
}

void things_end(struct surface *s, struct mesh *mesh)
{
    caster_free((struct caster *)(uintptr_t)s->caster);
    mesh_free(mesh);
}
