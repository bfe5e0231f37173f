/* SPDX-License-Identifier: MIT */
/* Scene files and --set: lines to settings. */
#include "scene_file.h"

#include <ctype.h>
#include <errno.h>
#include <string.h>

#include "noises.h"
#include "scene_emission.h"
#include "scene_files.h"
#include "scene_keys.h"

/// Lines ///

char *scene_trimmed(char *s)
{
    while (isspace((unsigned char)*s))
        s++;
    size_t n = strlen(s);
    while (n > 0 && isspace((unsigned char)s[n - 1]))
        s[--n] = '\0';
    return s;
}

int scene_check_line(const char *text, const char *where, char *err,
                     size_t err_size)
{
    if (strlen(text) >= SCENE_LINE_SIZE) {
        snprintf(err, err_size, "%s: line of more than %d bytes", where,
                 SCENE_LINE_SIZE - 1);
        return -1;
    }
    for (; *text; text++)
        if (iscntrl((unsigned char)*text) && *text != '\t') {
            snprintf(err, err_size, "%s: control character in the line", where);
            return -1;
        }
    return 0;
}

bool scene_next_line(FILE *f, char line[SCENE_LINE_SIZE + 1])
{
    size_t n = 0;
    bool comment = false;
    int c = getc(f);
    if (c == EOF)
        return false;
    for (; c != EOF && c != '\n'; c = getc(f)) {
        comment = comment || c == '#';
        if (comment)
            continue;
        /* A zero would hide the rest of the line: any other control
         * character is refused. */
        line[n++] = c == 0 ? '\1' : (char)c;
        if (n == SCENE_LINE_SIZE)
            break;
    }
    line[n] = '\0';
    return true;
}

/// Settings ///

/* A noise that is a file is read at once, so that what is wrong with it has
 * its line. */
static int read_noise(struct scene_settings *settings, const char *path,
                      const char *where, char *err, size_t err_size)
{
    char reason[SCENE_LINE_SIZE];
    settings->noise_file =
        noise_is_file(path) ? noise_read(path, reason, sizeof reason) : NULL;
    if (noise_is_file(path) && settings->noise_file == NULL) {
        snprintf(err, err_size, "%s: %s", where, reason);
        return -1;
    }
    return 0;
}

/* The value of a key, or the file that it names. */
static int read_value(struct scene_settings *settings, int key,
                      const char *value, const char *where, char *err,
                      size_t err_size)
{
    if (key == SCENE_NOISE &&
        read_noise(settings, value, where, err, err_size) != 0)
        return -1;
    if (key == SCENE_NOISE && settings->noise_file != NULL)
        return 0;
    if (key == SCENE_EMISSION)
        return scene_emission_read(value, settings->value[key],
                                   &settings->emission_file, where, err,
                                   err_size);
    if (scene_keys[key].kind == SCENE_IS_FILE)
        return scene_file_load(key, value,
                               &settings->file[key - SCENE_FILE_FIRST], where,
                               err, err_size);
    return scene_read_value(key, value, settings->value[key], where, err,
                            err_size);
}

int scene_set(struct scene_settings *settings, const char *text,
              const char *where, char *err, size_t err_size)
{
    char line[SCENE_LINE_SIZE];
    if (scene_check_line(text, where, err, err_size) != 0)
        return -1;
    strcpy(line, text);
    char *equals = strchr(line, '=');
    if (equals == NULL) {
        snprintf(err, err_size, "%s: no '=' in '%.40s'", where, text);
        return -1;
    }
    *equals = '\0';
    const char *name = scene_trimmed(line), *value = scene_trimmed(equals + 1);
    for (int i = 0; i < SCENE_KEYS; i++) {
        if (strcmp(scene_keys[i].name, name) != 0)
            continue;
        if (read_value(settings, i, value, where, err, err_size) != 0)
            return -1;
        settings->set[i] = true;
        snprintf(settings->where[i], sizeof settings->where[i], "%s", where);
        return 0;
    }
    snprintf(err, err_size,
             "%s: unknown key '%.40s' (brume render --help lists them)", where,
             name);
    return -1;
}

int scene_read(struct scene_settings *settings, const char *path, char *err,
               size_t err_size)
{
    char line[SCENE_LINE_SIZE + 1], where[SCENE_WHERE_SIZE];
    FILE *f = fopen(path, "r");
    int result = 0;
    if (f == NULL) {
        snprintf(err, err_size, "%s: %s", path, strerror(errno));
        return -1;
    }
    for (int n = 1; result == 0 && scene_next_line(f, line); n++) {
        snprintf(where, sizeof where, "%.250s:%d", path, n);
        bool fits = strlen(line) < SCENE_LINE_SIZE;
        const char *text = fits ? scene_trimmed(line) : line;
        if (*text)
            result = scene_set(settings, text, where, err, err_size);
    }
    if (result == 0 && ferror(f)) {
        snprintf(err, err_size, "%s: %s", path, strerror(errno));
        result = -1;
    }
    fclose(f);
    return result;
}

int scene_fill(struct scene_settings *settings, const char *text, char *err,
               size_t err_size)
{
    struct scene_settings fresh;
    char line[SCENE_LINE_SIZE];
    memset(&fresh, 0, sizeof fresh);
    while (*text) {
        size_t n = strcspn(text, "\n");
        snprintf(line, sizeof line, "%.*s", (int)n, text);
        if (scene_set(&fresh, line, "default", err, err_size) != 0)
            return -1;
        text += n + (text[n] == '\n');
    }
    for (int i = 0; i < SCENE_KEYS; i++) {
        if (settings->set[i])
            continue;
        settings->set[i] = fresh.set[i];
        memcpy(settings->value[i], fresh.value[i], sizeof fresh.value[i]);
        memcpy(settings->where[i], fresh.where[i], sizeof fresh.where[i]);
        if (scene_keys[i].kind == SCENE_IS_FILE)
            settings->file[i - SCENE_FILE_FIRST] =
                fresh.file[i - SCENE_FILE_FIRST];
    }
    return 0;
}

int scene_option(const char *command, struct scene_settings *settings,
                 const char *name, const char *value)
{
    char err[512];
    int bad = strcmp(name, "--scene") == 0
                  ? scene_read(settings, value, err, sizeof err)
                  : scene_set(settings, value, "--set", err, sizeof err);
    if (bad)
        fprintf(stderr, "brume %s: %s\n", command, err);
    return bad ? 3 : 0;
}
