#include "ui/canvas/tools/preset_overrides.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

typedef struct Pair {
    const char *name, *value;
    size_t name_length, value_length;
} Pair;

/* The next pair at *at; false at the end. Parts without '=' are skipped. */
static bool next(const char **at, Pair *pair)
{
    while (*at && **at) {
        size_t length = strcspn(*at, ";");
        const char *from = *at, *equals = memchr(from, '=', length);
        *at += length + (from[length] == ';');
        if (!equals) continue;
        *pair = (Pair){ from, equals + 1, (size_t)(equals - from),
                        length - (size_t)(equals + 1 - from) };
        return true;
    }
    return false;
}

static bool is(const Pair *pair, const char *name)
{
    return strlen(name) == pair->name_length && strncmp(pair->name, name, pair->name_length) == 0;
}

bool wr_tuning_get(const char *set, const char *name, double *value)
{
    Pair pair;
    for (const char *at = set; next(&at, &pair);)
        if (is(&pair, name)) return wr_number_parse(pair.value, pair.value_length, value);
    return false;
}

static void add_name(WrText *out, const char *name, size_t length)
{
    if (out->length > 0) wr_text_add(out, ";");
    wr_text_add_n(out, name, length);
    wr_text_add(out, "=");
}

void wr_tuning_put_text(const char *set, const char *name, const char *value, WrText *out)
{
    Pair pair;
    bool there = !value;
    wr_text_clear(out);
    for (const char *at = set; next(&at, &pair);) {
        bool same = is(&pair, name);
        if (same && there) continue; /* removed, or a duplicate */
        add_name(out, pair.name, pair.name_length);
        if (same) wr_text_add(out, value);
        else wr_text_add_n(out, pair.value, pair.value_length);
        there |= same;
    }
    if (there) return;
    add_name(out, name, strlen(name));
    wr_text_add(out, value);
}

void wr_tuning_put(const char *set, const char *name, double value, WrText *out)
{
    char number[WR_NUMBER_SIZE];
    wr_tuning_put_text(set, name, isnan(value) ? NULL : wr_number_print(value, number), out);
}

bool wr_tuning_has(const char *set, const char *name)
{
    Pair pair;
    for (const char *at = set; next(&at, &pair);)
        if (is(&pair, name)) return true;
    return false;
}

int wr_tuning_count(const char *set)
{
    Pair pair;
    int count = 0;
    for (const char *at = set; next(&at, &pair);) count++;
    return count;
}
