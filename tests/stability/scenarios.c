/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "stability.h"

#define PI 3.14159265358979323846

/// Camera ///

static int32_t q16(double v)
{
    return (int32_t)lround(v * 65536);
}

/* From an eye towards an azimuth and an elevation, degrees. */
static void look(struct brume_scene *s, const double eye[3], double azimuth,
                 double elevation)
{
    double a = azimuth * PI / 180, e = elevation * PI / 180;
    const double d[3] = {cos(e) * sin(a), sin(e), cos(e) * cos(a)};
    for (int i = 0; i < 3; i++) {
        s->eye[i] = q16(eye[i]);
        s->target[i] = q16(eye[i] + 100 * d[i]);
    }
}

/* At the middle of the volume, from a distance. */
static void orbit(struct brume_scene *s, const struct brume_volume *v,
                  double azimuth, double elevation, double distance)
{
    double a = azimuth * PI / 180, e = elevation * PI / 180;
    const double d[3] = {cos(e) * sin(a), sin(e), cos(e) * cos(a)};
    double eye[3];
    for (int i = 0; i < 3; i++)
        eye[i] = (v->box_min[i] + v->box_max[i]) / 2.0 + distance * d[i];
    look(s, eye, azimuth + 180, -elevation);
}

static void shift(struct brume_scene *s, int axis, double voxels)
{
    s->eye[axis] += q16(voxels);
    s->target[axis] += q16(voxels);
}

/// On the Disney cloud ///

/* It fills the frame, a pixel about a voxel wide. */
static void set_still(struct brume_scene *s, const struct brume_volume *v,
                      int frame)
{
    (void)frame;
    s->fov = 22 << 16;
    orbit(s, v, 30, 10, 150);
}

static void set_pan(struct brume_scene *s, const struct brume_volume *v,
                    int frame)
{
    double eye[3];
    set_still(s, v, frame);
    for (int i = 0; i < 3; i++)
        eye[i] = s->eye[i] / 65536.0;
    look(s, eye, 183 + 1.5 * frame, -10);
}

static void set_rotation(struct brume_scene *s, const struct brume_volume *v,
                         int frame)
{
    s->fov = 22 << 16;
    orbit(s, v, 30 + 2.0 * frame, 10, 150);
}

/* A few tenths of a pixel per frame. */
static void set_drift(struct brume_scene *s, const struct brume_volume *v,
                      int frame)
{
    s->fov = 22 << 16;
    orbit(s, v, 30 + 0.25 * frame, 10, 150 - 0.1 * frame);
}

static void set_dolly(struct brume_scene *s, const struct brume_volume *v,
                      int frame)
{
    double eye[3];
    for (int i = 0; i < 3; i++)
        eye[i] = (v->box_min[i] + v->box_max[i]) / 2.0;
    eye[0] += 58;
    eye[1] += 8;
    eye[2] += 110 - 2.5 * frame;
    look(s, eye, 188, 0);
}

static void set_enter(struct brume_scene *s, const struct brume_volume *v,
                      int frame)
{
    orbit(s, v, 30, 10, 118 - 3.0 * frame);
}

static void set_cut(struct brume_scene *s, const struct brume_volume *v,
                    int frame)
{
    set_still(s, v, frame);
    if (frame < 12)
        orbit(s, v, 200, 30, 120);
    s->cut = frame == 12;
}

static void set_sun(struct brume_scene *s, const struct brume_volume *v,
                    int frame)
{
    set_still(s, v, frame);
    brume_direction(s->sun, (5 * frame - 60) * 65536, 30 << 16);
}

/// Others ///

/* All from the first one's camera and extinction: their pools lie alike. */
static void set_fire(struct brume_scene *s, const struct brume_volume *v,
                     int frame)
{
    struct brume_scene first;
    (void)v;
    (void)frame;
    brume_scene_default(&first, stage_volume("fire0"));
    memcpy(s->eye, first.eye, sizeof s->eye);
    memcpy(s->target, first.target, sizeof s->target);
    s->density_scale = first.density_scale;
    s->fov = 22 << 16;
    s->light = BRUME_NO_LIGHT;
    s->background[0] = 0;
}

/* White things before black. */
static void set_bright(struct brume_scene *s, double density)
{
    s->light = BRUME_NO_LIGHT;
    s->background[0] = 0;
    s->density_scale = BRUME_Q32(density);
    s->step = 0x8000;
}

static void set_filaments(struct brume_scene *s, const struct brume_volume *v,
                          int frame)
{
    set_bright(s, 2);
    orbit(s, v, 20 + 0.5 * frame, 12, 110);
}

static void set_puffs(struct brume_scene *s, const struct brume_volume *v,
                      int frame)
{
    set_bright(s, 2);
    orbit(s, v, 0, 0, 500);
    shift(s, 0, (frame - 12) * 2.7);
    shift(s, 1, (frame - 12) * 1.1);
}

static void set_edge(struct brume_scene *s, const struct brume_volume *v,
                     int frame)
{
    set_bright(s, 4);
    orbit(s, v, 0, 0, 100);
    shift(s, 0, frame * 2.0 - 40);
}

const struct scenario scenarios[] = {
    /* name, what, frames, last, fixed, period, set, methods. FAST has 32
     * frames, and places in the pixel have 16. */
    {"still", "nothing moves", 64, 32, true, 32, set_still, NULL},
    {"pan", "the camera turns, 3.5 pixels per frame", 24, 2, false, 0, set_pan,
     NULL},
    {"rotation", "the camera goes around, 2 degrees per frame", 24, 2, false, 0,
     set_rotation, NULL},
    {"drift", "slowly around, some tenths of a pixel per frame", 40, 2, false,
     0, set_drift, NULL},
    {"dolly", "ahead past the edge of the cloud", 24, 2, false, 0, set_dolly,
     NULL},
    {"enter", "the camera enters the cloud", 24, 2, false, 0, set_enter, NULL},
    {"cut", "the two frames from a cut on", 14, 2, true, 0, set_cut, NULL},
    {"sun", "the sun moves 5 degrees per frame", 24, 2, false, 0, set_sun,
     NULL},
    {"fire", "another volume in each frame", 24, 2, false, 0, set_fire, NULL},
    {"filaments", "strands half a pixel thick, from around", 24, 2, false, 0,
     set_filaments, NULL},
    {"puffs", "half a pixel each, passing by", 24, 2, false, 0, set_puffs,
     NULL},
    {"edge", "a white wall before black, 1.5 pixels per frame", 24, 2, false, 0,
     set_edge, NULL},
    {"long", "nothing moves, 10,000 frames", 10000, 32, true, 32, set_still,
     "ema,ema-8bit,ema-64th,taa,taa-8bit,window8,taa-bayer4"},
};
const int scenario_count = sizeof scenarios / sizeof scenarios[0];

static const struct brume_volume *volume_of(const struct scenario *scenario,
                                            int frame)
{
    /* To and fro: neighbours in time stay neighbours. */
    static const char *const k_fire[] = {"fire0", "fire1", "fire2", "fire3",
                                         "fire4", "fire3", "fire2", "fire1"};
    if (scenario->set == set_fire)
        return stage_volume("fire0") ? stage_volume(k_fire[frame & 7]) : NULL;
    if (scenario->set == set_filaments)
        return stage_volume("filaments");
    if (scenario->set == set_puffs)
        return stage_volume("puffs");
    if (scenario->set == set_edge)
        return stage_volume("wall");
    return stage_volume("disney");
}

bool scenario_scene(const struct scenario *scenario, int frame,
                    struct brume_scene *scene,
                    const struct brume_volume **volume)
{
    struct brume_scene *s = scene;
    *volume = volume_of(scenario, frame);
    if (*volume == NULL)
        return false;
    brume_scene_default(s, *volume);
    s->width = STABILITY_WIDTH;
    s->height = STABILITY_HEIGHT;
    s->frame = (uint32_t)frame;
    s->output = BRUME_LINEAR;
    s->filter = BRUME_TRILINEAR;
    s->light = BRUME_LOG;
    s->light_samples = 8;
    s->light_step = 0x10000;
    s->step = 4 << 16;
    scenario->set(s, *volume, frame);
    return true;
}
