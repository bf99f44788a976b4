/* Text form of a choice, one line:
     2 256x256 turn=0 table=HASH scene=HASH met=yes rms=0.003 max=0.1 parts=central,exact,1,0,3;... blocks=a12b.4
   parts: slopes, normal, level, mesh, kinds. blocks: row by row, a letter for the part, '.' for none, and the
   run length. Text that begins with 1 has blocks of twice the side. */
#include "accuracy/tolerance_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define FORMAT '2'
#define FORMAT_WIDE '1'        /* with blocks of twice the side; only read */
#define BLOCKS_MAX (256 << 10) /* bytes */
#define MAX_SIDE 65536         /* pixels */
_Static_assert(PARTS_MAX <= 26, "every part has a letter");

typedef struct WrittenPart {
    WrScheme scheme;
    WrBumpMode mode;
    int level, mesh;
    unsigned kinds;
} WrittenPart;

typedef struct Written {
    bool wide; /* FORMAT_WIDE */
    int width, height;
    bool turning;
    double turn_deg;
    char table[33], scene[33];
    bool met;
    double rms, max;
    int count;
    WrittenPart parts[PARTS_MAX];
    const char *blocks;
} Written;

static int64_t count_along(int pixels, int block)
{
    return (pixels + block - 1) / block;
}

static int64_t count_blocks(int width, int height, int block)
{
    return count_along(width, block) * count_along(height, block);
}

/* ---- writing ---- */

/* Run-length code: neighbours mostly have the same part, so a picture of 10^4 blocks takes a few hundred
   bytes. */
static void add_blocks(const unsigned char *part_of, int64_t count, WrText *text)
{
    for (int64_t b = 0, end; b < count; b = end) {
        const int part = part_of[b];
        for (end = b + 1; end < count && part_of[end] == part;) end++;
        wr_text_addf(text, "%c", part == WR_CHOICE_NOTHING ? '.' : 'a' + part);
        if (end > b + 1) wr_text_addf(text, "%lld", (long long)(end - b));
    }
}

static bool is_finer(const WrChoicePart *a, const WrChoicePart *b)
{
    if (a->level != b->level) return a->level > b->level;
    return a->price > b->price;
}

static void add_part(const WrChoicePart *part, WrText *text)
{
    wr_text_addf(text, "%s,%s,%d,%d,%u", wr_schemes[part->scene->scheme].name,
                 wr_bumps[part->scene->bump].name, part->level, part->scene->dials.mesh,
                 part->kinds);
}

/* A text beyond BLOCKS_MAX is replaced by the finest part everywhere: slower, but within the tolerance. */
static void add_parts(const WrChoice *choice, WrText *text)
{
    const int64_t count = count_blocks(choice->width, choice->height, WR_FRAME_BLOCK);
    WrText blocks = { 0 };
    add_blocks(choice->part_of, count, &blocks);
    wr_text_add(text, " parts=");
    if (blocks.length <= BLOCKS_MAX) {
        for (int i = 0; i < choice->count; i++) {
            if (i > 0) wr_text_add(text, ";");
            add_part(&choice->parts[i], text);
        }
        wr_text_addf(text, " blocks=%s", wr_text_get(&blocks));
    } else {
        const WrChoicePart *finest = &choice->parts[0];
        for (int i = 1; i < choice->count; i++)
            if (is_finer(&choice->parts[i], finest)) finest = &choice->parts[i];
        add_part(finest, text);
        wr_text_addf(text, " blocks=a%lld", (long long)count);
    }
    wr_text_fini(&blocks);
}

void wr_choice_write(const WrChoice *choice, const WrChoiceOrigin *origin, WrText *text)
{
    char table[33], scene[33];
    wr_hash_print(origin->table, table);
    wr_hash_print(origin->scene, scene);
    wr_text_addf(text, "%c %dx%d turn=", FORMAT, choice->width, choice->height);
    if (choice->turning) wr_text_add(text, "any");
    else wr_text_add_number(text, choice->turn_deg);
    wr_text_addf(text, " table=%s scene=%s met=%s rms=", table, scene, choice->met ? "yes" : "no");
    wr_text_add_number(text, choice->rms);
    wr_text_add(text, " max=");
    wr_text_add_number(text, choice->max);
    add_parts(choice, text);
}

/* ---- parsing ---- */

/* The text may come from a damaged or foreign document: every number has a range, every name a table, and
   nothing is stored before all is valid. */

/* Parses the text after NAME up to `end`, of 1 to room - 1 bytes; *p moves after `end`. The last item of a list
   has no ';'. */
static bool take(const char **p, const char *name, char end, char *out, size_t room)
{
    const size_t before = strlen(name);
    if (strncmp(*p, name, before) != 0) return false;
    const char *from = *p + before, *to = strchr(from, end);
    const bool last = !to && end == ';';
    const size_t length = last ? strlen(from) : to ? (size_t)(to - from) : 0;
    if (length == 0 || length >= room) return false;
    const bool more = !last && end != '\0';
    if (more && to[1] == '\0') return false; /* nothing follows */
    memcpy(out, from, length);
    out[length] = '\0';
    *p = from + length + more;
    return true;
}

static bool take_number(const char **p, const char *name, char end, double low, double high,
                        double *out)
{
    char word[40];
    return take(p, name, end, word, sizeof word) && wr_number_parse(word, strlen(word), out) &&
           *out >= low && *out <= high;
}

static bool take_whole(const char **p, const char *name, char end, double low, double high,
                       int *out)
{
    double value;
    if (!take_number(p, name, end, low, high, &value) || value != floor(value)) return false;
    *out = (int)value;
    return true;
}

static bool take_hash(const char **p, const char *name, char out[33])
{
    return take(p, name, ' ', out, 33) && strspn(out, "0123456789abcdef") == 32;
}

static bool take_turn(const char **p, Written *out)
{
    out->turning = strncmp(*p, "turn=any ", 9) == 0;
    if (out->turning) *p += 9;
    return out->turning || take_number(p, "turn=", ' ', -INFINITY, INFINITY, &out->turn_deg);
}

static bool take_met(const char **p, Written *out)
{
    char word[4];
    if (!take(p, "met=", ' ', word, sizeof word)) return false;
    out->met = strcmp(word, "yes") == 0;
    return out->met || strcmp(word, "no") == 0;
}

static bool parse_part(const char *text, WrittenPart *out)
{
    const WrDial *dial = &wr_dials[WR_DIAL_MESH];
    char scheme[24], mode[24];
    int kinds, found = 0;
    const char *p = text;
    if (!take(&p, "", ',', scheme, sizeof scheme) || !take(&p, "", ',', mode, sizeof mode) ||
        !take_whole(&p, "", ',', 0, TOP, &out->level) ||
        !take_whole(&p, "", ',', dial->low, dial->high, &out->mesh) ||
        !take_whole(&p, "", '\0', 0, (1 << KIND_BITS * KIND_COUNT) - 1, &kinds))
        return false;
    out->kinds = (unsigned)kinds;
    found = wr_scheme_find(scheme);
    out->scheme = (WrScheme)found;
    for (int i = 0; i < WR_BUMP_COUNT; i++) {
        if (strcmp(mode, wr_bumps[i].name) != 0) continue;
        out->mode = (WrBumpMode)i;
        return found >= 0;
    }
    return false;
}

static bool take_parts(const char **p, Written *out)
{
    char parts[PARTS_MAX * 64], part[64];
    const char *at = parts;
    if (!take(p, "parts=", ' ', parts, sizeof parts)) return false;
    while (*at && out->count < PARTS_MAX) {
        if (!take(&at, "", ';', part, sizeof part)) return false;
        if (!parse_part(part, &out->parts[out->count++])) return false;
    }
    return *at == '\0';
}

/* Parses one run of blocks: their part, and their number, at most `most`.
   The loop ends once count exceeds `most`, before it can overflow. */
static bool take_run(const char **p, int parts, int64_t most, int *part, int64_t *count)
{
    const char letter = *(*p)++;
    *part = letter == '.' ? WR_CHOICE_NOTHING : letter - 'a';
    if (letter != '.' && (letter < 'a' || *part >= parts)) return false;
    *count = **p >= '0' && **p <= '9' ? 0 : 1;
    for (; **p >= '0' && **p <= '9' && *count <= most; ++*p) *count = 10 * *count + (**p - '0');
    return *count >= 1 && *count <= most;
}

/* part_of: of blocks as written; NULL: validates only. */
static bool parse_blocks(const Written *written, unsigned char *part_of)
{
    const int block = written->wide ? 2 * WR_FRAME_BLOCK : WR_FRAME_BLOCK;
    const int64_t count = count_blocks(written->width, written->height, block);
    const char *p = written->blocks;
    int64_t at = 0;
    while (*p) {
        int part;
        int64_t run;
        if (!take_run(&p, written->count, count - at, &part, &run)) return false;
        if (part_of) memset(part_of + at, part, (size_t)run);
        at += run;
    }
    return at == count;
}

/* NULL: valid; else a description of the damage. */
static const char *parse(const char *text, Written *out)
{
    const char *p = text;
    *out = (Written){ 0 };
    if ((*p != FORMAT && *p != FORMAT_WIDE) || p[1] != ' ') return "version";
    out->wide = *p == FORMAT_WIDE;
    p += 2;
    if (!take_whole(&p, "", 'x', 1, MAX_SIDE, &out->width) ||
        !take_whole(&p, "", ' ', 1, MAX_SIDE, &out->height))
        return "size";
    if (!take_turn(&p, out)) return "turn";
    if (!take_hash(&p, "table=", out->table)) return "table";
    if (!take_hash(&p, "scene=", out->scene)) return "scene";
    if (!take_met(&p, out)) return "met";
    if (!take_number(&p, "rms=", ' ', 0, INFINITY, &out->rms)) return "rms";
    if (!take_number(&p, "max=", ' ', 0, INFINITY, &out->max)) return "max";
    if (!take_parts(&p, out)) return "parts";
    if (strncmp(p, "blocks=", 7) != 0) return "blocks";
    out->blocks = p + 7;
    return parse_blocks(out, NULL) ? NULL : "blocks";
}

bool wr_choice_check(const char *text, WrError *err)
{
    Written written;
    const char *damaged = parse(text, &written);
    if (!damaged) return true;
    return wr_fail(err,
                   "no dials as save writes them: damaged in its %s (leave it out, and they "
                   "are chosen anew)",
                   damaged);
}

/* ---- reading ---- */

/* Text is used only if its origin, size and turn are those of the request; otherwise the search runs again. */

static bool same_hash(const char *written, WrHash hash)
{
    char text[33];
    wr_hash_print(hash, text);
    return strcmp(written, text) == 0;
}

const char *wr_choice_misfit(const char *text, const WrChoiceOrigin *origin,
                             const WrFrameRequest *request)
{
    Written written;
    if (parse(text, &written)) return "program";
    if (written.width != request->width || written.height != request->height) return "size";
    if (!written.turning && written.turn_deg != request->turn_deg) return "turn";
    if (!same_hash(written.table, origin->table)) return "table";
    return same_hash(written.scene, origin->scene) ? NULL : "scene";
}

bool wr_choice_is_for(const char *text, const WrChoiceOrigin *origin)
{
    Written written;
    return !parse(text, &written) && same_hash(written.table, origin->table) &&
           same_hash(written.scene, origin->scene);
}

static WrChoicePart make_part(const WrScene *scene, const WrittenPart *written)
{
    WrChoicePart part = { .level = written->level, .kinds = written->kinds };
    part.scene =
        wr_level_scene(scene, written->scheme, written->mode, written->level, written->mesh);
    part.price = wr_price_sample(scene, written->scheme, written->mode);
    wr_part_name(&part);
    return part;
}

/* Expands the blocks. The caller frees.
   Two blocks along each side show the part of the old, wider one. b / across is the row, b % across the
   column. */
static unsigned char *read_blocks(const Written *written, int64_t count)
{
    unsigned char *part_of = wr_alloc((size_t)count, 1), *wide;
    if (!written->wide) {
        parse_blocks(written, part_of);
        return part_of;
    }
    const int64_t across = count_along(written->width, WR_FRAME_BLOCK);
    const int64_t wide_across = count_along(written->width, 2 * WR_FRAME_BLOCK);
    wide = wr_alloc((size_t)count, 1); /* a quarter is used */
    parse_blocks(written, wide);
    for (int64_t b = 0; b < count; b++)
        part_of[b] = wide[b / across / 2 * wide_across + b % across / 2];
    wr_free(wide);
    return part_of;
}

void wr_choice_read(const char *text, const WrFrameRequest *request, WrChoice *out)
{
    Written written;
    if (parse(text, &written)) return;
    const int64_t count = count_blocks(written.width, written.height, WR_FRAME_BLOCK);
    WrChoice choice = { .width = written.width,
                        .height = written.height,
                        .met = written.met,
                        .rms = written.rms,
                        .max = written.max,
                        .tables_key = wr_choice_tables_key(request),
                        .turn_deg = written.turn_deg,
                        .turning = written.turning,
                        .count = written.count };
    choice.scene = wr_scene_share(request->scene);
    choice.parts = wr_alloc(PARTS_MAX, sizeof *choice.parts);
    choice.part_of = read_blocks(&written, count);
    for (int i = 0; i < written.count; i++)
        choice.parts[i] = make_part(request->scene, &written.parts[i]);
    for (int64_t b = 0; b < count; b++)
        if (choice.part_of[b] != WR_CHOICE_NOTHING) choice.parts[choice.part_of[b]].blocks++;
    wr_choice_say(&choice, &request->scene->tolerance,
                  "dials as they were written down, nothing was chosen anew");
    wr_choice_fini(out);
    *out = choice;
}
