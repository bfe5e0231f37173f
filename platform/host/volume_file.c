/* SPDX-License-Identifier: MIT */
#include "volume_file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "deflate.h"

/// Bytes ///

static uint32_t get32(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 |
           (uint32_t)p[3] << 24;
}

static double get_f64(const uint8_t *p)
{
    uint64_t bits = (uint64_t)get32(p + 4) << 32 | get32(p);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/// Header ///

/* The name's section, if there is one. Its bounds are checked: volume_open
 * has passed. Bytes that would upset a terminal become '?'. */
static void read_name(struct volume_file *file, const uint8_t *p)
{
    unsigned n = p[BRUME_OFF_SECTIONS];
    for (unsigned i = 0; i < n; i++) {
        const uint8_t *s = p + BRUME_HEADER_BYTES + i * BRUME_SECTION_BYTES;
        if (get32(s) != BRUME_SECTION_NAME)
            continue;
        size_t bytes = get32(s + 8);
        if (bytes > sizeof file->name - 1)
            bytes = sizeof file->name - 1;
        memcpy(file->name, p + get32(s + 4), bytes);
        for (size_t k = 0; k < bytes; k++)
            if ((unsigned char)file->name[k] < 0x20 || file->name[k] == 0x7f)
                file->name[k] = '?';
    }
}

/* The linear part must be a rotation times one scale, to 1 part in 1000. */
static int check_transform(struct volume_file *file)
{
    const double *m = file->world_from_index;
    double dot[3][3];
    for (int i = 0; i < 12; i++)
        if (!isfinite(m[i]))
            return -1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            dot[i][j] = m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j];
    double square = (dot[0][0] + dot[1][1] + dot[2][2]) / 3;
    if (!(square > 0) || !isfinite(square))
        return -1;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (fabs(dot[i][j] - (i == j ? square : 0)) > 1e-3 * square)
                return -1;
    file->voxel_size = sqrt(square);
    return 0;
}

static int read_header(struct volume_file *file)
{
    const uint8_t *p = file->data;
    for (int i = 0; i < 3; i++) {
        uint32_t bits = get32(p + BRUME_OFF_ORIGIN + 4 * i);
        memcpy(&file->origin[i], &bits, sizeof bits);
    }
    for (int i = 0; i < 12; i++)
        file->world_from_index[i] = get_f64(p + BRUME_OFF_WORLD + 8 * i);
    read_name(file, p);
    return check_transform(file);
}

/// File ///

static int map_file(struct volume_file *file, const char *path, char *err,
                    size_t err_size)
{
    struct stat st;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0 || fstat(fd, &st) != 0) {
        snprintf(err, err_size, "%s: %s", path, strerror(errno));
        if (fd >= 0)
            close(fd);
        return -1;
    }
    if (!S_ISREG(st.st_mode) || st.st_size == 0) {
        snprintf(err, err_size, "%s: %s", path,
                 S_ISREG(st.st_mode) ? "the file is empty"
                                     : "not a regular file");
        close(fd);
        return -1;
    }
    file->size = (size_t)st.st_size;
    file->data = mmap(NULL, file->size, PROT_READ, MAP_PRIVATE, fd, 0);
    close(fd);
    if (file->data == MAP_FAILED) {
        snprintf(err, err_size, "%s: cannot map: %s", path, strerror(errno));
        file->data = NULL;
        return -1;
    }
    return 0;
}

/* As the core would, with the host's faster checksum. */
static int check_volume(struct volume_file *file)
{
    const uint8_t *p = file->data;
    int error =
        brume_volume_open(&file->volume, p, file->size, BRUME_OPEN_NO_CRC);
    if (error != BRUME_OK && error > BRUME_ERR_HEADER)
        return error; /* not so much as a header */
    uint32_t size = get32(p + BRUME_OFF_SIZE);
    if (size < BRUME_HEADER_BYTES)
        return error;
    uint32_t crc =
        deflate_crc32(0, p + BRUME_OFF_FORMAT, size - BRUME_OFF_FORMAT);
    return crc == get32(p + BRUME_OFF_CRC) ? error : BRUME_ERR_CRC;
}

int volume_file_open(struct volume_file *file, const char *path, char *err,
                     size_t err_size)
{
    memset(file, 0, sizeof *file);
    if (map_file(file, path, err, err_size) != 0)
        return -1;
    int error = check_volume(file);
    if (error == BRUME_ERR_TRUNCATED && file->size > BRUME_OFF_CRC)
        snprintf(err, err_size, "%s: %s: %zu bytes of %lu", path,
                 brume_error_text(error), file->size,
                 (unsigned long)get32((uint8_t *)file->data + BRUME_OFF_SIZE));
    else if (error)
        snprintf(err, err_size, "%s: %s", path, brume_error_text(error));
    else if (read_header(file) != 0)
        snprintf(err, err_size,
                 "%s: world transform at byte %d is not a finite rotation "
                 "and scale",
                 path, BRUME_OFF_WORLD);
    else
        return 0;
    volume_file_close(file);
    return -1;
}

void volume_file_close(struct volume_file *file)
{
    if (file->data != NULL)
        munmap(file->data, file->size);
    memset(file, 0, sizeof *file);
}

/// Spaces ///

/* The inverse of a rotation times a scale is its transpose over the scale
 * squared. */
void volume_file_direction(const struct volume_file *file,
                           const double world[3], double pool[3])
{
    const double *m = file->world_from_index;
    double square = file->voxel_size * file->voxel_size;
    for (int i = 0; i < 3; i++)
        pool[i] =
            (m[i] * world[0] + m[4 + i] * world[1] + m[8 + i] * world[2]) /
            square;
}

void volume_file_to_pool(const struct volume_file *file, const double world[3],
                         double pool[3])
{
    double from_corner[3];
    for (int i = 0; i < 3; i++)
        from_corner[i] = world[i] - file->world_from_index[4 * i + 3];
    volume_file_direction(file, from_corner, pool);
    for (int i = 0; i < 3; i++)
        pool[i] -= file->origin[i];
}

void volume_file_to_world(const struct volume_file *file, const double pool[3],
                          double world[3])
{
    const double *m = file->world_from_index;
    for (int i = 0; i < 3; i++) {
        world[i] = m[4 * i + 3];
        for (int j = 0; j < 3; j++)
            world[i] += m[4 * i + j] * (pool[j] + file->origin[j]);
    }
}
