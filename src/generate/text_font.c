/* Choice of the fonts of a text: the requested one, and fallbacks for its missing characters. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "generate/tile_builder.h"
#include "generate/text_layout.h"

#include <string.h>

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
        wr_text_addf(&line, "; %s has them: fallback= takes it, missing=borrow finds it", lender);
    else if (found > 0) wr_text_addf(&line, "; %s has them: name it as well", lender);
    else
        wr_text_add(&line, "; no installed font has them (Debian's fonts-noto-core has most "
                           "scripts, fonts-noto-cjk those of China, Japan and Korea)");
    wr_generate_note(fonts->job, "drawn as the font's sign for what it lacks:%s",
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

/* Adds fonts until nothing is missing or none helps. */
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

bool wr_text_shape(const WrParams *params, const WrFontRequest *ask, double size,
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
