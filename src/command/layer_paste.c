#include "command/layer_paste.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"
#include "generate/generator.h"

#include <string.h>

static void note(void *ctx, const char *text)
{
    wr_session_note(ctx, "%s", text);
}

/* Run the picture generator with the line's values. */
static bool make(WrSession *session, const WrCall *call, const char *path, WrRelief *out,
                 WrError *err)
{
    const WrGenerator *generator = wr_generator_find("picture", "paste");
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generator_defaults(generator, values);
    values[wr_generator_param_find(generator, "file")].text = path;
    if (wr_call_given(call, "at"))
        memcpy(values[wr_generator_param_find(generator, "at")].number,
               wr_call_arg(call, "at")->numbers, 2 * sizeof(double));
    if (wr_call_given(call, "size"))
        values[wr_generator_param_find(generator, "size")].number[0] = wr_call_number(call, "size");
    const WrGenerateJob job = { .like = session->state.document->layers[0].heights,
                                .pool = session->options.pool,
                                .progress = wr_progress_here(),
                                .note = note,
                                .note_ctx = session };
    return wr_generator_make(generator, values, &job, out, err);
}

bool wr_layer_paste(WrSession *session, WrCall *call, WrLayer layer, WrError *err)
{
    WrDocument *document = session->state.document;
    WrRelief relief = { NULL, NULL };
    char *path = wr_session_input_path(session, wr_call_arg(call, "FILE")->text);
    const bool good =
        wr_session_check_sha256(call, path, err) && make(session, call, path, &relief, err);
    wr_free(path);
    if (!good) {
        wr_layer_fini(&layer);
        return false;
    }
    wr_field_free(layer.heights);
    wr_field_free(layer.cover);
    layer.heights = relief.heights;
    layer.cover = relief.cover;
    layer.blend = WR_BLEND_REPLACE;
    wr_document_insert(document, document->active + 1, layer);
    document->active++;
    wr_field_free(document->selection);
    document->selection = NULL;
    return true;
}
