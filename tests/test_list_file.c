/* SPDX-License-Identifier: MIT */
/* Lists as text: fields and numbers, and every refusal with its line. */
#include "tap.h"

#include "list_file.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char file[64];
static char err[512];

static int read_bytes(struct list *list, const char *text, size_t size,
                      size_t most)
{
    FILE *f = fopen(file, "w");
    if (f == NULL || fwrite(text, 1, size, f) != size || fclose(f) != 0) {
        perror(file);
        exit(1);
    }
    memset(err, 0, sizeof err);
    return list_read(list, file, most, "things", err, sizeof err);
}

static int read_text(struct list *list, const char *text, size_t most)
{
    return read_bytes(list, text, strlen(text), most);
}

static void test_fields(void)
{
    struct list list;
    double v[3];
    int result = read_text(&list,
                           "# nothing\n\n  1,2.5,-3 \t40 spot # there\n"
                           "word\n",
                           2);
    tap_check(result == 0 && list.count == 2 && list.item[0].count == 3 &&
                  list.item[1].count == 1,
              "comments and empty lines are no items: %s", err);
    tap_check(list_numbers(&list.item[0], 0, "place", 3, -5, 5, v, err,
                           sizeof err) == 0 &&
                  v[0] == 1 && v[1] == 2.5 && v[2] == -3 &&
                  list_numbers(&list.item[0], 1, "size", 1, 0, 40, v, err,
                               sizeof err) == 0 &&
                  v[0] == 40,
              "numbers of fields: %s", err);
    tap_check(list_is_word(&list.item[0], 2, "spot") &&
                  !list_is_word(&list.item[0], 2, "spo") &&
                  !list_is_word(&list.item[0], 3, "spot"),
              "words of fields");
    list_free(&list);
    tap_check(read_text(&list, "", 1) == 0 && list.count == 0,
              "an empty file is an empty list");
    list_free(&list);
}

/* The message is the file's name, then what is said here. */
static bool says(const char *what)
{
    size_t n = strlen(file);
    bool good = strncmp(err, file, n) == 0 && strcmp(err + n, what) == 0;
    if (!good)
        printf("# %s\n", err);
    return good;
}

static void test_numbers_refused(void)
{
    static const struct {
        const char *text;
        int n;
        const char *says;
    } k_bad[] = {
        {"a 1,2", 3, ":1: place is three numbers x,y,z, not '1,2'"},
        {"a 1,2,", 2, ":1: place is two numbers x,y, not '1,2,'"},
        {"a nan", 1, ":1: place is a number, not 'nan'"},
        {"a 0x10", 1, ":1: place is a number, not '0x10'"},
        {"\n#\na", 1, ":3: place is a number, not the line's end"},
        {"a 8.5", 1, ":1: place is 8.5, outside -8 to 8"},
        {"a 1,-9,1", 3, ":1: place is -9, outside -8 to 8"},
    };
    for (size_t i = 0; i < sizeof k_bad / sizeof *k_bad; i++) {
        struct list list;
        double v[4];
        bool good = read_text(&list, k_bad[i].text, 1) == 0;
        good = good && list_numbers(&list.item[0], 1, "place", k_bad[i].n, -8,
                                    8, v, err, sizeof err) == -1;
        tap_check(good && says(k_bad[i].says), "refused: %s", k_bad[i].says);
        list_free(&list);
    }
}

static void check_refused(const char *text, size_t size, size_t most,
                          const char *what, const char *name)
{
    struct list list;
    int result = read_bytes(&list, text, size, most);
    tap_check(result == -1 && list.item == NULL && says(what), "%s", name);
    list_free(&list);
}

static void test_limits(void)
{
    struct list list;
    static char big[LIST_BYTES + 2];
    char text[3 * LIST_FIELDS + 3];
    tap_check(read_text(&list, "a\nb\n\n# c\n", 2) == 0 && list.count == 2,
              "as many items as may be: %s", err);
    list_free(&list);
    check_refused("a\nb\n\nc", 6, 2, ":4: more than 2 things",
                  "one item too many");
    for (int i = 0; i < LIST_FIELDS + 1; i++)
        memcpy(text + 2 * i, "x ", 3);
    tap_check(read_bytes(&list, text, 2 * LIST_FIELDS, 1) == 0 &&
                  list.item[0].count == LIST_FIELDS,
              "as many fields as may be: %s", err);
    list_free(&list);
    check_refused(text, 2 * LIST_FIELDS + 2, 1,
                  ":1: more than 32 fields in a line", "one field too many");
    memset(big, 'x', sizeof big);
    check_refused(big, SCENE_LINE_SIZE, 1, ":1: line of more than 511 bytes",
                  "a line that is too long");
    memset(big, '#', sizeof big);
    check_refused(big, sizeof big, 1, ":1: more than 1048576 bytes",
                  "a file that is too long");
    check_refused("a\0b", 3, 1, ":1: control character in the line",
                  "a control character");
    snprintf(err, sizeof err, "none");
    tap_check(list_read(&list, "no/such/file", 1, "things", err, sizeof err) ==
                      -1 &&
                  strcmp(err, "no/such/file: No such file or directory") == 0,
              "no file: %s", err);
}

int main(void)
{
    const char *tmp = getenv("TMPDIR");
    snprintf(file, sizeof file, "%.40s/brumeXXXXXX", tmp ? tmp : "/tmp");
    int handle = mkstemp(file);
    if (handle < 0) {
        perror(file);
        return 1;
    }
    close(handle);
    test_fields();
    test_numbers_refused();
    test_limits();
    unlink(file);
    return tap_done();
}
