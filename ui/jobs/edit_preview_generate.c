#include "ui/jobs/edit_preview_generate.h"

#include "base/array.h"
#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/generate.h"
#include "command/transform.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"
#include "generate/generator.h"

#include <math.h>
#include <string.h>

#define ROUGH_TEXELS 262144.0 /* approximate size of a rough table */
#define ROUGH_LEAST 16        /* least texels along a side */

static void note(void *ctx, const char *text)
{
    wr_text_addf(ctx, "%s\n", text);
}

/* Reduction factor of a rough table. Generators with a position, files or text keep the full size: their heights or
   grain may depend on texels. */
static int rough_step(const WrGenerator *generator, const WrField *like)
{
    double texels = (double)wr_field_width(like) * wr_field_height(like);
    int least =
        wr_field_width(like) < wr_field_height(like) ? wr_field_width(like) : wr_field_height(like);
    for (const WrParam *p = generator->params; p->name; p++)
        if (p->kind == WR_PARAM_FILE || p->kind == WR_PARAM_TEXT || strcmp(p->name, "at") == 0)
            return 1;
    /* Reduction by step on both axes divides the number of texels by its square. */
    int step = (int)ceil(sqrt(texels / ROUGH_TEXELS));
    return step < 1 || least / step < ROUGH_LEAST ? 1 : step;
}

/* Convert lengths in texels to a table that is `step` times smaller. */
static void shrink(const WrGenerator *generator, WrParamValue *values, int step)
{
    for (int i = 0; generator->params[i].name; i++) {
        const WrParam *p = &generator->params[i];
        bool length = p->unit && strcmp(p->unit, "texels") == 0;
        if (!length || (p->kind != WR_PARAM_NUMBER && p->kind != WR_PARAM_TUPLE)) continue;
        for (int k = 0; k < 3; k++) {
            double small = values[i].number[k] / step;
            if (small >= p->low && !(p->above && small == p->low)) values[i].number[k] = small;
        }
    }
}

static WrField *resized(const WrField *field, int width, int height, WrPool *pool,
                        const WrProgress *progress, WrError *err)
{
    const double param[] = { width, height, WR_RESIZE_LINEAR };
    const WrOpOptions options = { .pool = pool, .progress = progress };
    return wr_op_run(wr_op_find("resize"), field, param, &options, err);
}

static bool enlarge(WrField **field, const WrField *like, const WrGenerateJob *job, WrError *err)
{
    if (!*field) return true;
    WrField *large =
        resized(*field, wr_field_width(like), wr_field_height(like), job->pool, job->progress, err);
    if (!large) return false;
    wr_field_free(*field);
    *field = large;
    return true;
}

static bool make_small(const WrGenerator *generator, WrParamValue *values, WrGenerateJob *job,
                       int step, WrRelief *out, WrError *err)
{
    const WrField *like = job->like;
    WrField *small =
        resized(like, (wr_field_width(like) + step - 1) / step,
                (wr_field_height(like) + step - 1) / step, job->pool, job->progress, err);
    if (!small) return false;
    shrink(generator, values, step);
    job->like = small;
    WrRelief made = { NULL, NULL };
    bool good = wr_generator_make(generator, values, job, &made, err) &&
                enlarge(&made.heights, like, job, err) && enlarge(&made.cover, like, job, err);
    wr_field_free(small);
    job->like = like;
    if (good) *out = made;
    else wr_relief_fini(&made);
    return good;
}

static bool make(const WrCall *call, WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const WrGenerator *generator = wr_call_generator(call);
    WrParamValue values[WR_GENERATOR_PARAMS];
    char *owned[WR_GENERATOR_PARAMS] = { NULL };
    wr_call_values(call, generator, values);
    for (int i = 0; generator->params[i].name; i++)
        if (generator->params[i].kind == WR_PARAM_TEXT && values[i].text)
            values[i].text = owned[i] = wr_generator_text(values[i].text);
    int step = job->coarse ? rough_step(generator, job->like) : 1;
    bool good = step > 1 ? make_small(generator, values, job, step, out, err)
                         : wr_generator_make(generator, values, job, out, err);
    for (int i = 0; i < WR_GENERATOR_PARAMS; i++) wr_free(owned[i]);
    return good;
}

bool wr_edit_preview_generate(WrDocument *document, const char *line, bool rough, WrPool *pool,
                              const WrProgress *progress, WrText *notes, WrError *err)
{
    WrCall *call = NULL;
    if (!wr_call_parse(line, false, &call, err)) return false;
    WrRelief relief = { NULL, NULL };
    WrStandIn stand_in = { .index = 0 };
    WrLayer *layer = wr_document_edit_begin(document, &stand_in);
    WrGenerateJob job = { .like = layer->heights,
                          .selection = document->selection,
                          .mask = document->layers[document->active].mask,
                          .pool = pool,
                          .progress = progress,
                          .coarse = rough,
                          .note = note,
                          .note_ctx = notes };
    bool good = wr_call_generator(call) ? make(call, &job, &relief, err)
                                        : wr_fail(err, "%s: must be a generator's line", line);
    good = good && wr_call_join(call, &relief, document->selection, layer, pool, progress, err);
    wr_document_edit_end(document, &stand_in);
    wr_relief_fini(&relief);
    wr_call_free(call);
    return good;
}

bool wr_edit_preview_transform(WrDocument *document, const char *line, WrPool *pool,
                               const WrProgress *progress, WrError *err)
{
    WrCall *call = NULL;
    WrStandIn stand_in = { .index = 0 };
    if (!wr_call_parse(line, false, &call, err)) return false;
    bool all = wr_call_choice(call, "layers") == 1;
    WrLayer *layer = all ? NULL : wr_document_edit_begin(document, &stand_in);
    bool good = wr_call_transform(call, document, layer, pool, progress, err);
    wr_document_edit_end(document, &stand_in);
    wr_call_free(call);
    return good;
}
