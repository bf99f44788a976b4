/* A word in a font as a small picture, rendered by the text generator. The sample thus matches the result, and a
   damaged font can harm only the reader process. */
#include "ui/generate/font_choice.h"
#include "ui/jobs/edit_preview_generate.h"

#include "base/error.h"
#include "base/text.h"
#include "command/command_line.h"
#include "document/document.h"
#include "field/field.h"

#include <math.h>

#define BASELINE 0.72 /* fraction of the height, from the top */
#define LETTERS 0.62  /* font size, as a fraction of the height */

static void line_of(const WrFontSample *sample, WrText *line)
{
    wr_text_add(line, "text ");
    wr_text_add_word(line, sample->named ? sample->named : sample->entry->sample);
    if (sample->named) {
        wr_text_addf(line, " font=%s", sample->named);
    } else {
        wr_text_add(line, " file=");
        wr_text_add_word(line, sample->entry->path);
        wr_text_addf(line, " face=%d", sample->entry->face);
    }
    wr_text_addf(line, " size=%d at=", (int)floor(LETTERS * sample->h + 0.5));
    wr_text_add_number(line, 2.0 / sample->w);
    wr_text_add(line, ",");
    wr_text_add_number(line, 1.0 - floor(BASELINE * sample->h) / sample->h);
    wr_text_add(line,
                " align=left anchor=baseline profile=flat bevel=0 height=1 edge=clip missing=sign");
}

bool wr_font_sample(const WrFontSample *sample, WrPool *pool, const WrProgress *progress,
                    uint32_t *argb)
{
    WrError err;
    WrText line = { 0 }, notes = { 0 };
    WrField *level =
        wr_field_new(sample->w, sample->h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, &err);
    if (!level) return false;
    WrDocument *document = wr_document_new();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = level;
    line_of(sample, &line);
    const bool good =
        wr_edit_preview_generate(document, wr_text_get(&line), false, pool, progress, &notes, &err);
    const WrField *made = document->layers[0].heights;
    for (int y = 0; good && y < sample->h; y++)
        for (int x = 0; x < sample->w; x++) {
            const double part = fmin(1.0, fmax(0.0, (double)wr_field_get(made, x, y)));
            argb[y * sample->w + x] = (uint32_t)floor(part * 255.0 + 0.5) << 24 | 0xffffffu;
        }
    wr_text_fini(&line);
    wr_text_fini(&notes);
    wr_document_free(document);
    return good;
}
