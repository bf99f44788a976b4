#include "base/udim.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

#define DIGITS 4
#define LISTED 12 /* numbers of a list */

int wr_udim_number(double column, double row)
{
    const double number = WR_UDIM_FIRST + column + 10 * row;
    return column >= 0 && column <= 9 && row >= 0 && number <= WR_UDIM_LAST ? (int)number : 0;
}

/* The number at the start of a text; 0: none. */
static int number_at(const char *text)
{
    int number = 0;
    for (int i = 0; i < DIGITS; i++) {
        if (text[i] < '0' || text[i] > '9') return 0;
        number = 10 * number + (text[i] - '0');
    }
    return number >= WR_UDIM_FIRST ? number : 0;
}

bool wr_udim_parse(const char *text, int *number)
{
    *number = strlen(text) == DIGITS ? number_at(text) : 0;
    return *number != 0;
}

bool wr_udim_is_pattern(const char *path)
{
    return strstr(path, WR_UDIM_PATTERN) != NULL;
}

char *wr_udim_fill(const char *pattern, int number)
{
    WrText text = { 0 };
    for (const char *next; (next = strstr(pattern, WR_UDIM_PATTERN));
         pattern = next + sizeof WR_UDIM_PATTERN - 1) {
        wr_text_add_n(&text, pattern, (size_t)(next - pattern));
        wr_text_addf(&text, "%d", number);
    }
    wr_text_add(&text, pattern);
    return text.data;
}

/* The ending with its dot; the end of the path if it has none. */
static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    return dot && dot > name ? dot : path + strlen(path);
}

char *wr_udim_insert(const char *path, int number)
{
    const char *end = ending_of(path);
    WrText text = { 0 };
    wr_text_add_n(&text, path, (size_t)(end - path));
    wr_text_addf(&text, ".%d%s", number, end);
    return text.data;
}

/* The pattern of a name, or of its folder's entries; NULL: the name has no number. */
static char *pattern_of(const char *path, int *own)
{
    const char *end = ending_of(path);
    *own = 0;
    if (wr_udim_is_pattern(path)) return wr_strdup(path);
    if (!*end || end - path < DIGITS + 2 || end[-DIGITS - 1] != '.') return NULL;
    *own = number_at(end - DIGITS);
    if (*own == 0) return NULL;
    WrText text = { 0 };
    wr_text_add_n(&text, path, (size_t)(end - path) - DIGITS);
    wr_text_addf(&text, WR_UDIM_PATTERN "%s", end);
    return text.data;
}

/* The number with which a name follows the pattern; 0: it does not. A later <UDIM> stands for the same number. */
static int number_in(const char *pattern, const char *name)
{
    int number = 0;
    for (const char *next; (next = strstr(pattern, WR_UDIM_PATTERN));
         pattern = next + sizeof WR_UDIM_PATTERN - 1) {
        const size_t before = (size_t)(next - pattern);
        if (strncmp(pattern, name, before) != 0) return 0;
        const int own = number_at(name + before);
        if (own == 0 || (number != 0 && own != number)) return 0;
        number = own;
        name += before + DIGITS;
    }
    return strcmp(pattern, name) == 0 ? number : 0;
}

static int rising(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

int wr_udim_files(const char *path, int *own, int *numbers, int most)
{
    char *pattern = pattern_of(path, own);
    if (!pattern) return 0;
    const char *slash = strrchr(pattern, '/'), *name = slash ? slash + 1 : pattern;
    char *place = wr_path_folder(path);
    WrFolder *folder = wr_udim_is_pattern(name) ? wr_folder_open(place) : NULL;
    int *found = wr_alloc(WR_UDIM_COUNT, sizeof *found), count = 0;
    for (const char *entry; folder && (entry = wr_folder_next(folder));) {
        const int number = number_in(name, entry);
        if (number && count < WR_UDIM_COUNT) found[count++] = number;
    }
    wr_folder_close(folder);
    wr_free(place);
    wr_free(pattern);
    qsort(found, (size_t)count, sizeof *found, rising);
    for (int i = 0; i < count && i < most; i++) numbers[i] = found[i];
    wr_free(found);
    return count;
}

void wr_udim_list(const int *numbers, int count, WrText *text)
{
    for (int i = 0; i < count && i < LISTED; i++) wr_text_addf(text, i ? ", %d" : "%d", numbers[i]);
    if (count > LISTED) wr_text_add(text, ", ...");
}
