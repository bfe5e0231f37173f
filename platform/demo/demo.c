/* SPDX-License-Identifier: MIT */
/* What the demos of the boards share. */
#include "demo.h"

#include "print.h"
#include "semihosting.h"
#include "target.h"

/// Messages ///

static int failed(const char *what)
{
    target_write("error: ");
    target_write(what);
    target_write("\n");
    return DEMO_FAILED;
}

static int check(int error)
{
    return error ? failed(brume_error_text(error)) : DEMO_OK;
}

void demo_print(const char *what, uint64_t instructions)
{
    target_write(what);
    target_write(": ");
    print_number(instructions);
    target_write(" instructions, ");
    print_number(target_stack_used());
    target_write(" bytes of stack\n");
}

/// Volume and scene ///

int demo_open(struct brume_volume *volume)
{
    if (target_asset_count != 1)
        return failed("the demo wants one asset");
    return check(brume_volume_open(volume, target_assets->bytes,
                                   target_assets->size, 0));
}

void demo_scene(struct brume_scene *scene, const struct brume_volume *volume,
                unsigned width, unsigned height, int sun)
{
    brume_scene_default(scene, volume);
    scene->width = (uint16_t)width;
    scene->height = (uint16_t)height;
    scene->filter = BRUME_NEAREST;
    scene->light = BRUME_LOG;
    scene->light_samples = 10;
    scene->light_step = 0x10000u;
    scene->fov = 30u << 16; /* nearer than the default, which is wary */
    brume_direction(scene->sun, sun * 65536, 30 * 65536);
}

/// Frames ///

int demo_begin(struct brume_frame *frame, const struct brume_volume *volume,
               const struct brume_scene *scene, uint64_t *instructions)
{
    uint64_t start = target_instructions();
    int error = brume_begin_frame(frame, volume, scene);
    *instructions = target_instructions() - start;
    return check(error);
}

int demo_strip(const struct brume_frame *frame, unsigned y, unsigned rows,
               int pixel_format, void *strip, uint64_t *instructions)
{
    size_t stride = (size_t)frame->width * brume_pixel_bytes(pixel_format);
    uint64_t start = target_instructions();
    int error = brume_render_rect(frame, 0, y, frame->width, rows, pixel_format,
                                  strip, stride);
    *instructions += target_instructions() - start;
    return check(error);
}

/// Pictures ///

static char *put_number(char *to, unsigned number)
{
    char digits[10];
    int n = 0;
    do
        digits[n++] = (char)('0' + number % 10u);
    while ((number /= 10u) != 0);
    while (n > 0)
        *to++ = digits[--n];
    return to;
}

static int picture_failed(struct demo_picture *picture)
{
    semihosting_close(picture->handle);
    semihosting_remove(picture->path);
    return failed("cannot write the picture");
}

int demo_picture_begin(struct demo_picture *picture, const char *path,
                       unsigned channels, unsigned width, unsigned height)
{
    char head[40] = "P5\n", *to = head + 3;
    head[1] = channels == 3 ? '6' : '5';
    to = put_number(to, width);
    *to++ = ' ';
    to = put_number(to, height);
    *to++ = '\n';
    to = put_number(to, 255);
    *to++ = '\n';
    picture->path = path;
    picture->handle = semihosting_create(path);
    if (picture->handle < 0)
        return failed("cannot create the picture");
    return demo_picture_add(picture, head, (uint32_t)(to - head));
}

int demo_picture_add(struct demo_picture *picture, const void *bytes,
                     uint32_t size)
{
    if (!semihosting_write(picture->handle, bytes, size))
        return picture_failed(picture);
    return DEMO_OK;
}

int demo_picture_end(struct demo_picture *picture)
{
    if (!semihosting_close(picture->handle)) {
        semihosting_remove(picture->path);
        return failed("cannot close the picture");
    }
    return DEMO_OK;
}
