/* GIMP's .gih: a line with the name, a line with the number of pictures and "name:value" words, then
   the pictures as consecutive .gbr files. Relevant words: dim (ranks), rank0.. (size of each), sel0..
   or selection (selection rule). The cells are ordered like the digits of a number, rank 0 first. */
#include "brush/tip_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"

#include <string.h>

#define WR_GIH_LINE 65536u /* maximum bytes of one line */

typedef struct Line {
    const uint8_t *text;
    size_t length;
} Line;

/* The next line without its end; false if there is none. */
static bool next_line(const uint8_t *bytes, size_t size, size_t *offset, Line *line)
{
    size_t left = size - *offset, limit = left < WR_GIH_LINE ? left : WR_GIH_LINE;
    const uint8_t *start = bytes + *offset;
    const uint8_t *end = limit > 0 ? memchr(start, '\n', limit) : NULL;
    if (!end) return false;
    *offset += (size_t)(end - start) + 1;
    line->text = start;
    line->length = (size_t)(end - start);
    if (line->length > 0 && start[line->length - 1] == '\r') line->length--;
    return true;
}

static bool next_word(Line *line, Line *word)
{
    while (line->length > 0 && (line->text[0] == ' ' || line->text[0] == '\t')) {
        line->text++;
        line->length--;
    }
    size_t n = 0;
    while (n < line->length && line->text[n] != ' ' && line->text[n] != '\t') n++;
    *word = (Line){ line->text, n };
    line->text += n;
    line->length -= n;
    return n > 0;
}

static bool whole_number(Line word, int *number)
{
    double x;
    if (!wr_number_parse((const char *)word.text, word.length, &x)) return false;
    if (!(x >= 0 && x <= 1e9) || x != (double)(int)x) return false;
    *number = (int)x;
    return true;
}

static bool is(Line word, const char *text)
{
    return word.length == strlen(text) && memcmp(word.text, text, word.length) == 0;
}

/* The digit of a word that consists of `name` and a digit, else -1. */
static int numbered(Line word, const char *name)
{
    size_t n = strlen(name);
    if (word.length != n + 1 || memcmp(word.text, name, n) != 0) return -1;
    return word.text[n] >= '0' && word.text[n] <= '9' ? word.text[n] - '0' : -1;
}

/* Inputs that strokes lack (velocity, xtilt, ytilt) are treated as constant. */
static WrTipRule rule_of(Line word)
{
    static const struct {
        const char *name;
        WrTipRule rule;
    } rules[] = { { "incremental", WR_TIP_INCREMENTAL },
                  { "angular", WR_TIP_ANGULAR },
                  { "angle", WR_TIP_ANGULAR },
                  { "random", WR_TIP_RANDOM },
                  { "pressure", WR_TIP_PRESSURE } };
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
        if (is(word, rules[i].name)) return rules[i].rule;
    return WR_TIP_CONSTANT;
}

typedef struct Ranks {
    int dim;
    int rank[WR_TIP_RANKS];
    WrTipRule rule[WR_TIP_RANKS];
} Ranks;

static Ranks read_ranks(Line line)
{
    Ranks r = { .dim = 1 };
    Line word;
    for (int i = 0; i < WR_TIP_RANKS; i++) r.rule[i] = WR_TIP_INCREMENTAL;
    while (next_word(&line, &word)) {
        const uint8_t *colon = memchr(word.text, ':', word.length);
        if (!colon) continue;
        size_t n = (size_t)(colon - word.text);
        Line name = { word.text, n }, value = { colon + 1, word.length - n - 1 };
        int number = 0, at = numbered(name, "rank");
        if (is(name, "dim") && whole_number(value, &number)) r.dim = number;
        if (at >= 0 && at < WR_TIP_RANKS && whole_number(value, &number)) r.rank[at] = number;
        at = is(name, "selection") ? 0 : numbered(name, "sel");
        if (at < 0) at = numbered(name, "selection");
        if (at >= 0 && at < WR_TIP_RANKS) r.rule[at] = rule_of(value);
    }
    return r;
}

/* Ranks that do not match the number of cells are replaced by one rank of all cells, with the first's
 * rule. */
static void set_ranks(WrTip *tip, const Ranks *r)
{
    int64_t product = 1;
    bool good = r->dim >= 1 && r->dim <= WR_TIP_RANKS;
    for (int i = 0; good && i < r->dim; i++) {
        good = r->rank[i] >= 1 && r->rank[i] <= tip->cells;
        product *= good ? r->rank[i] : 0;
    }
    tip->rule[0] = r->rule[0];
    if (!good || product != tip->cells) return;
    tip->ranks = r->dim;
    for (int i = 0; i < r->dim; i++) {
        tip->rank[i] = r->rank[i];
        tip->rule[i] = r->rule[i];
    }
}

static bool read_cells(WrTip *tip, const uint8_t *bytes, size_t size, const char *what,
                       WrError *err)
{
    size_t used = 0;
    for (int i = 0; i < tip->cells; i++) {
        size_t length = 0;
        double *spacing = i == 0 ? &tip->spacing : NULL;
        if (!wr_tip_parse_gbr(tip, i, bytes + used, size - used, &length, NULL, spacing, what,
                              err)) {
            wr_error_prefix(err, "picture %d of %d: ", i + 1, tip->cells);
            return false;
        }
        used += length;
    }
    return true;
}

WrTip *wr_tip_parse_gih(const uint8_t *bytes, size_t size, const char *what, WrError *err)
{
    size_t offset = 0;
    Line name, line, word;
    int count = 0;
    if (!next_line(bytes, size, &offset, &name) || !next_line(bytes, size, &offset, &line) ||
        !next_word(&line, &word) || !whole_number(word, &count)) {
        wr_fail(err,
                "%s: not a brush of GIMP: neither a .gbr header, nor a .gih's two lines with "
                "a name and a number of pictures",
                what);
        return NULL;
    }
    if (count < 1 || count > WR_TIP_CELLS) {
        wr_fail(err, "%s: %d pictures: must be 1..%d", what, count, WR_TIP_CELLS);
        return NULL;
    }
    WrTip *tip = wr_tip_blank(count);
    if (!read_cells(tip, bytes + offset, size - offset, what, err)) {
        wr_tip_free(tip);
        return NULL;
    }
    Ranks ranks = read_ranks(line);
    set_ranks(tip, &ranks);
    tip->name = wr_tip_clean_name(name.text, name.length);
    return tip;
}
