#include "ui/toolkit/folds.h"

#include "base/memory.h"

#include <string.h>

static int find(char *const *folds, const char *name)
{
    for (int i = 0; i < WR_FOLDS_MAX && folds[i]; i++)
        if (strcmp(folds[i] + 1, name) == 0) return i;
    return -1;
}

static int count_of(char *const *folds)
{
    int count = 0;
    while (count < WR_FOLDS_MAX && folds[count]) count++;
    return count;
}

static void drop(char **folds, int at)
{
    const int count = count_of(folds);
    wr_free(folds[at]);
    memmove(folds + at, folds + at + 1, (size_t)(count - at - 1) * sizeof *folds);
    folds[count - 1] = NULL;
}

bool wr_folds_is_open(char *const folds[WR_FOLDS_MAX], const char *name, bool open_at_first)
{
    const int at = find(folds, name);
    return at >= 0 ? folds[at][0] == '+' : open_at_first;
}

void wr_folds_set(char *folds[WR_FOLDS_MAX], const char *name, bool open_at_first, bool open)
{
    const int at = find(folds, name);
    if (at >= 0) drop(folds, at);
    if (open == open_at_first) return;
    if (count_of(folds) == WR_FOLDS_MAX) drop(folds, 0);
    const size_t length = strlen(name) + 1;
    char *entry = wr_alloc(1 + length, 1);
    entry[0] = open ? '+' : '-';
    memcpy(entry + 1, name, length);
    folds[count_of(folds)] = entry;
}
