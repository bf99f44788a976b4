/* The text generator: from parameters to placed outlines. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "generate/generator.h"
#include "generate/text_relief.h"
#include "generate/tile_builder.h"

#include <string.h>

/* ---- text font ---- */

/* Choice of the fonts of a text: the requested one, and fallbacks for its missing characters. */

#define NAMED 12 /* maximum characters listed in a remark */

static const char *const others[WR_FONT_OTHERS] = { "fallback", "fallback2", "fallback3" };

typedef struct Fonts {
    const WrParams *params;
    const WrGenerateJob *job;
    const char *file; /* of the first font */
    char *found;      /* owned; NULL: given as a file */
    WrFontRequest ask;
    char *lent[WR_FONT_OTHERS]; /* owned; chosen automatically */
    int lent_count;
} Fonts;

static bool tell(const WrGenerateJob *job, const char *param, const char *value, WrError *err)
{
    return !job->chose || job->chose(job->chose_ctx, param, value, err);
}

/* ---- notes ---- */

static void list_characters(const WrFontText *text, WrText *line)
{
    for (int i = 0; i < text->missing_count && i < NAMED; i++)
        wr_text_addf(line, "%s U+%04X", i ? "," : "", text->missing[i]);
    if (text->missing_count > NAMED) wr_text_add(line, " and others");
}

static void note_lent(const Fonts *fonts, const WrFontText *text)
{
    for (int f = 0; f < WR_FONT_OTHERS && fonts->ask.others[f]; f++) {
        int count = 0;
        for (int32_t i = 0; i < text->placed_count; i++)
            count += text->glyphs[text->placed[i].glyph].font == f + 1;
        if (count > 0)
            wr_generate_note(fonts->job, "the font lacks letters: %d glyph%s from %s", count,
                             count == 1 ? " is" : "s are", fonts->ask.others[f]);
    }
}

static void note_missing(const Fonts *fonts, const WrFontText *text, const char *kind)
{
    if (text->missing_count == 0) return;
    WrText line = { 0 };
    char *lender = NULL;
    list_characters(text, &line);
    int found =
        wr_font_lenders(text->missing, text->missing_count, kind, fonts->ask.language, 1, &lender);
    if (found > 0 && !fonts->ask.others[0])
        wr_text_addf(&line, "; %s has them: fallback= uses it, missing=borrow finds it", lender);
    else if (found > 0) wr_text_addf(&line, "; %s has them: name it as well", lender);
    else
        wr_text_add(&line, "; no installed font has them (Debian's fonts-noto-core has most "
                           "scripts, fonts-noto-cjk those of China, Japan and Korea)");
    wr_generate_note(fonts->job, "drawn as the font's sign for missing characters:%s",
                     wr_text_get(&line));
    if (found > 0) wr_free(lender);
    wr_text_fini(&line);
}

/* ---- fallback fonts ---- */

/* Shapes with one more font, which is kept if it contains missing characters. */
static bool try_lender(Fonts *fonts, char *path, WrFontText *text)
{
    WrFontText more = { 0 };
    WrError why = { "" };
    int place = fonts->lent_count;
    bool good = true;
    for (int i = 0; i < place; i++) good = good && strcmp(path, fonts->lent[i]) != 0;
    fonts->ask.others[place] = path;
    good = good && wr_font_shape(fonts->file, &fonts->ask, &more, &why);
    bool helps = false;
    for (int32_t i = 0; good && i < more.placed_count && !helps; i++)
        helps = more.glyphs[more.placed[i].glyph].font == place + 1;
    if (!helps) {
        fonts->ask.others[place] = NULL;
        wr_font_text_fini(&more);
        wr_free(path);
        return false;
    }
    fonts->lent[fonts->lent_count++] = path;
    wr_font_text_fini(text);
    *text = more;
    return true;
}

/* Adds fonts until nothing is missing or none helps. Automatic choices are passed to `chose` so that the journal holds
   explicit font names: a repetition on another machine fails loudly instead of using another font. */
static bool borrow(Fonts *fonts, const char *kind, WrFontText *text, WrError *err)
{
    while (text->missing_count > 0 && fonts->lent_count < WR_FONT_OTHERS) {
        char *path = NULL;
        if (wr_progress_cancelled(fonts->job->progress)) return wr_fail(err, "cancelled");
        if (wr_font_lenders(text->missing, text->missing_count, kind, fonts->ask.language, 1,
                            &path) == 0 ||
            !try_lender(fonts, path, text))
            break;
    }
    for (int i = 0; i < fonts->lent_count; i++)
        if (!tell(fonts->job, others[i], fonts->lent[i], err)) return false;
    return fonts->lent_count > 0 || tell(fonts->job, "missing", "sign", err);
}

/* ---- all ---- */

static bool find_first(Fonts *fonts, double size, WrError *err)
{
    fonts->file = wr_param_value(fonts->params, "file")->text;
    if (fonts->file && *fonts->file) return true;
    fonts->file = fonts->found = wr_font_find(wr_param_whole(fonts->params, "font"), size, err);
    return fonts->found && tell(fonts->job, "font", fonts->found, err);
}

static void take_named(Fonts *fonts)
{
    int count = 0;
    for (int i = 0; i < WR_FONT_OTHERS; i++) {
        const char *named = wr_param_value(fonts->params, others[i])->text;
        if (named && *named) fonts->ask.others[count++] = named;
    }
}

/* Shapes a text with the fonts of the parameters `font`, `file`, `missing`, `fallback`, `fallback2`,
 * `fallback3`. If the first one lacks letters, no fallback is given and missing=borrow, installed fonts
 * are used, and the job's `chose` callback receives them. Remarks list the fallback fonts and the
 * characters missing in all fonts. ask: everything except its fonts. */
static bool text_shape(const WrParams *params, const WrFontRequest *ask, double size,
                       const WrGenerateJob *job, WrFontText *out, WrError *err)
{
    Fonts fonts = { .params = params, .job = job, .ask = *ask };
    WrFontText text = { 0 };
    take_named(&fonts);
    bool good = find_first(&fonts, size, err);
    const char *kind = fonts.found ? wr_font_names[wr_param_whole(params, "font")] : "sans";
    bool may_borrow = !fonts.ask.others[0] && wr_param_whole(params, "missing") == WR_TEXT_BORROW;
    good = good && wr_font_shape(fonts.file, &fonts.ask, &text, err);
    if (good && may_borrow && text.missing_count > 0) good = borrow(&fonts, kind, &text, err);
    if (good) {
        int strange = wr_font_strange_bytes(ask->text);
        if (strange > 0)
            wr_generate_note(job, "%d byte%s of the text %s not UTF-8: drawn as U+FFFD", strange,
                             strange == 1 ? "" : "s", strange == 1 ? "is" : "are");
        note_lent(&fonts, &text);
        note_missing(&fonts, &text, kind);
        *out = text;
    } else {
        wr_font_text_fini(&text);
    }
    for (int i = 0; i < fonts.lent_count; i++) wr_free(fonts.lent[i]);
    wr_free(fonts.found);
    return good;
}

#define AROUNDS(X) X(OFF, "off") X(ALONG_U, "u") X(ALONG_V, "v") X(LATTICE, "lattice")
enum { AROUNDS(WR_WORD_ID) };
#define EDGES(X) X(WRAPPED, "wrap") X(CLIPPED, "clip")
enum { EDGES(WR_WORD_ID) };
static const char *const align_words[] = { WR_FONT_ALIGNS(WR_WORD) NULL };
static const char *const anchor_words[] = { WR_TEXT_ANCHORS(WR_WORD) NULL };
static const char *const direction_words[] = { WR_FONT_DIRECTIONS(WR_WORD) NULL };
static const char *const around_words[] = { AROUNDS(WR_WORD) NULL };
static const char *const missing_words[] = { WR_TEXT_MISSING(WR_WORD) NULL };
static const char *const edge_words[] = { EDGES(WR_WORD) NULL };
static const char *const profile_words[] = { WR_TEXT_PROFILES(WR_WORD) NULL };

static const WrParam params[] = {
    { .name = "text",
      .label = "Text",
      .help = "the text; \\n starts a new line, and so does \\\\n in double quotes",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .positional = true },
    WR_P_FONT(WR_FONT_TERMINUS),
    WR_P_FONT_FILE,
    { .name = "axes",
      .label = "Axes",
      .help = "axes of a variable font, such as wght=650,wdth=80",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "" },
    WR_P_MISSING("missing", missing_words),
    WR_P_FALLBACK("fallback", "Fallback font", "a font file for letters that the font lacks"),
    WR_P_FALLBACK("fallback2", "Second fallback font",
                  "a font file for characters that fallback= lacks too"),
    WR_P_FALLBACK("fallback3", "Third fallback font", "a font file for characters that both lack"),
    WR_P_ABOVE("size", "Size", 64, 0, WR_FONT_SIZE_MAX, 512, "texels",
               "font size (em); for a bitmap font its pixel height"),
    { .name = "at",
      .label = "Place",
      .help = "position of the text's anchor",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .fallback = { 0.5, 0.5 },
      .low = -64,
      .high = 64,
      .soft_low = 0,
      .soft_high = 1,
      .shape = "u,v",
      .components = 2 },
    WR_P_CHOICE("align", "Alignment", WR_FONT_CENTRE, align_words,
                "alignment of the lines with one another and to the anchor"),
    WR_P_CHOICE("anchor", "Anchor", WR_TEXT_MIDDLE, anchor_words, "vertical anchor of the text"),
    WR_P_NUMBER("letters", "Letter spacing", 0, -16384, 16384, 32, "texels",
                "extra space between letters"),
    WR_P_NUMBER("lines", "Line spacing", 1, 0, 100, 3, "",
                "line spacing, as a factor of the font's"),
    WR_P_NUMBER("rotate", "Turn", 0, -36000, 36000, 180, "degrees",
                "rotation about the anchor, anticlockwise"),
    WR_P_CHOICE("direction", "Direction", WR_FONT_AUTO, direction_words,
                "base direction of a line; auto: by its first letter"),
    { .name = "language",
      .label = "Language",
      .help = "language code, such as ar, hi, sr, for fonts with localized letters",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "" },
    { .name = "points",
      .label = "Path",
      .help = "points of a smooth curve that is the baseline",
      .unit = "",
      .kind = WR_PARAM_POINTS,
      .low = -64,
      .high = 64 },
    WR_P_CHOICE("around", "Around", OFF, around_words,
                "runs the text once around the table along u, v or the lattice direction; the "
                "letter spacing is adjusted so that it closes"),
    { .name = "lattice",
      .label = "Lattice direction",
      .help = "closed curve: number of tables to the right and up after which it repeats",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .fallback = { 1, 1 },
      .low = -16,
      .high = 16,
      .soft_low = -4,
      .soft_high = 4,
      .shape = "i,j",
      .components = 2 },
    WR_P_WHOLE("repeats", "Repeats", 0, 0, 4096, 16,
               "around=: number of repeats; 0: as many as fit best"),
    WR_P_CHOICE("edge", "Edges", WRAPPED, edge_words,
                "parts beyond a periodic edge continue on the other side, or are cut off"),
    WR_P_CHOICE("profile", "Profile", WR_TEXT_FLAT, profile_words,
                "profile of the relief's edge; for a ridge, bevel is the run for one height"),
    WR_P_TEXELS("bevel", "Bevel", 4, 64, "distance from the edge to full height"),
    WR_P_HEIGHT,
    WR_P_END
};

static WrTextRequest request_of(const WrParams *p)
{
    const WrParamValue *at = wr_param_value(p, "at"), *lattice = wr_param_value(p, "lattice");
    const WrParamValue *path = wr_param_value(p, "points");
    const char *language = wr_param_value(p, "language")->text;
    const char *axes = wr_param_value(p, "axes")->text;
    WrTextRequest wish = {
        .setting = { .size = wr_param_number(p, "size"),
                     .letter_spacing = wr_param_number(p, "letters"),
                     .line_spacing = wr_param_number(p, "lines"),
                     .align = (WrFontAlign)wr_param_whole(p, "align") },
        .at = { at->number[0], at->number[1] },
        .anchor = (WrTextAnchor)wr_param_whole(p, "anchor"),
        .rotate_deg = wr_param_number(p, "rotate"),
        .points = path->points,
        .point_count = path->count,
        .around = wr_param_whole(p, "around") != OFF,
        .repeats = wr_param_whole(p, "repeats"),
        .clip = wr_param_whole(p, "edge") == CLIPPED,
    };
    wish.ask = (WrFontRequest){ .text = wr_param_value(p, "text")->text,
                                .face = wr_param_whole(p, "face"),
                                .direction = (WrFontDirection)wr_param_whole(p, "direction"),
                                .language = language && *language ? language : NULL,
                                .axes = axes && *axes ? axes : NULL };
    wish.lattice[0] = wr_param_whole(p, "around") == ALONG_U ? 1.0 : 0.0;
    wish.lattice[1] = wr_param_whole(p, "around") == ALONG_V ? 1.0 : 0.0;
    for (int k = 0; k < 2 && wr_param_whole(p, "around") == LATTICE; k++)
        wish.lattice[k] = lattice->number[k];
    return wish;
}

static bool make_shaped(const WrTextRequest *wish, const WrFontText *text,
                        const WrTextFinish *finish, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    WrTextShape shape = { 0 };
    if (!wr_text_shape_init(&shape, job->like, wish->clip, err)) return false;
    bool good =
        wr_text_lay(wish, text, job, &shape, err) && wr_text_relief(&shape, finish, job, out, err);
    wr_text_shape_fini(&shape);
    return good;
}

static bool make_text(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    WrParams p = { params, values };
    WrTextRequest wish = request_of(&p);
    WrTextFinish finish = { (WrTextProfile)wr_param_whole(&p, "profile"),
                            wr_param_number(&p, "bevel"), wr_param_number(&p, "height") };
    WrFontText text = { 0 };
    if (!text_shape(&p, &wish.ask, wish.setting.size, job, &text, err)) return false;
    bool good = make_shaped(&wish, &text, &finish, job, out, err);
    wr_font_text_fini(&text);
    return good;
}

const WrGenerator wr_text_rows[] = {
    { .family = "text",
      .label = "Text",
      .help = "write letters of any font and script in relief",
      .blend = "add",
      .params = params,
      .make = make_text },
    { .family = NULL },
};
