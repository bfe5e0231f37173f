/* SPDX-License-Identifier: MIT */
#include "out_file.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image_codec.h"

/// Interruption ///

/* The file that is being written, for the handler. */
static char *volatile s_temporary;

static void remove_temporary(int number)
{
    if (s_temporary != NULL)
        unlink(s_temporary);
    raise(number); /* as it was: the handler has been reset */
}

static void guard(char *temporary)
{
    static const int k_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    s_temporary = temporary;
    for (size_t i = 0; i < sizeof k_signals / sizeof *k_signals; i++) {
        struct sigaction now, ours = {0};
        ours.sa_handler = remove_temporary;
        ours.sa_flags = (int)SA_RESETHAND;
        if (sigaction(k_signals[i], NULL, &now) == 0 &&
            now.sa_handler == SIG_DFL)
            sigaction(k_signals[i], &ours, NULL);
    }
}

/// Files ///

static bool is_special(const char *path)
{
    struct stat st;
    return lstat(path, &st) == 0 && !S_ISREG(st.st_mode);
}

static int name_temporary(struct out_file *out, char *err, size_t err_size)
{
    size_t length = strlen(out->path) + 32;
    out->temporary = malloc(length);
    if (out->temporary == NULL)
        return image_error(err, err_size, "no memory");
    snprintf(out->temporary, length, "%s.tmp%ld", out->path, (long)getpid());
    guard(out->temporary);
    return 0;
}

int out_open(struct out_file *out, const char *path, char *err, size_t err_size)
{
    memset(out, 0, sizeof *out);
    out->path = path;
    if (strcmp(path, "-") == 0) {
        out->file = stdout;
        return 0;
    }
    /* A link is not replaced: it may be /dev/stdout. */
    if (!is_special(path) && name_temporary(out, err, err_size) != 0)
        return -1;
    out->file = fopen(out->temporary ? out->temporary : path, "wb");
    if (out->file != NULL)
        return 0;
    image_error(err, err_size, "cannot write: %s", strerror(errno));
    out_abandon(out);
    return -1;
}

int out_write(struct out_file *out, const void *data, size_t size, char *err,
              size_t err_size)
{
    if (fwrite(data, 1, size, out->file) == size)
        return 0;
    return image_error(err, err_size, "cannot write: %s", strerror(errno));
}

static void release(struct out_file *out)
{
    if (out->temporary != NULL)
        s_temporary = NULL;
    free(out->temporary);
    out->temporary = NULL;
    out->file = NULL;
}

int out_close(struct out_file *out, char *err, size_t err_size)
{
    bool good = fflush(out->file) == 0 && !ferror(out->file);
    if (out->file != stdout)
        good = fclose(out->file) == 0 && good;
    out->file = NULL;
    if (!good)
        image_error(err, err_size, "cannot write: %s", strerror(errno));
    if (good && out->temporary && rename(out->temporary, out->path) != 0) {
        image_error(err, err_size, "cannot replace: %s", strerror(errno));
        good = false;
    }
    if (!good)
        out_abandon(out);
    else
        release(out);
    return good ? 0 : -1;
}

void out_abandon(struct out_file *out)
{
    if (out->file != NULL && out->file != stdout)
        fclose(out->file);
    if (out->temporary != NULL)
        unlink(out->temporary);
    release(out);
}
