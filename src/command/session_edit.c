/* Helpers for commands that change a document, and their checks. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "document/edit.h"
#include "field/field.h"
#include "scene/objects.h"

#include <string.h>

/* ---- input files ---- */

void wr_session_note_input(WrSession *session, const char *path)
{
    for (int i = 0; i < session->inputs.count; i++)
        if (strcmp(session->inputs.data[i].path, path) == 0) return;
    wr_array_push(&session->inputs, ((WrSessionInput){ wr_strdup(path), wr_file_identity(path) }));
}

void wr_session_forget_inputs(WrSession *session)
{
    for (int i = 0; i < session->inputs.count; i++) wr_free((char *)session->inputs.data[i].path);
    wr_array_free(&session->inputs);
}

int wr_session_input_count(const WrSession *session)
{
    return session->inputs.count;
}

WrSessionInput wr_session_input(const WrSession *session, int index)
{
    return session->inputs.data[index];
}

char *wr_session_input_path(WrSession *session, const char *path)
{
    char *full = wr_path_join(session->folder, path);
    wr_session_note_input(session, full);
    return full;
}

void wr_session_replace_scene(WrSession *session, WrScene *scene)
{
    wr_scene_free(session->state.document->scene);
    session->state.document->scene = scene;
}

/* ---- layers ---- */

const char *wr_session_layer_name(const WrSession *session, int index, WrText *buffer)
{
    char excerpt[WR_EXCERPT_SIZE];
    wr_text_clear(buffer);
    wr_text_addf(buffer, "layer %d \"%s\"", index + 1,
                 wr_excerpt(session->state.document->layers[index].name, excerpt));
    return wr_text_get(buffer);
}

bool wr_session_check_unlocked(const WrSession *session, int index, WrError *err)
{
    if (!session->state.document->layers[index].locked) return true;
    WrText name = { 0 };
    wr_fail(err, "%s is locked: `layer set %d lock=off` unlocks it",
            wr_session_layer_name(session, index, &name), index + 1);
    wr_text_fini(&name);
    return false;
}

/* True if an object uses the layer as its table; a hidden layer is then visible on it. */
static bool is_worn(const WrDocument *document, int index)
{
    const char *name = document->layers[index].name;
    return document->solo < 0 && wr_scene_wears(document->scene, name);
}

static bool check_shown(const WrSession *session, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    if (wr_document_shows(document, index) || is_worn(document, index)) return true;
    WrText name = { 0 };
    wr_session_layer_name(session, index, &name);
    if (document->solo >= 0)
        wr_fail(err, "%s is not shown while layer %d is alone: `layer solo off` shows all",
                wr_text_get(&name), document->solo + 1);
    else
        wr_fail(err, "%s is hidden: `layer set %d visible=on` shows it", wr_text_get(&name),
                index + 1);
    wr_text_fini(&name);
    return false;
}

bool wr_session_check_heights(const WrSession *session, int index, WrError *err)
{
    const WrLayer *layer = &session->state.document->layers[index];
    if (!layer->filter.op || layer->on_mask) return true;
    WrText name = { 0 };
    wr_fail(err,
            "%s is a filter, without heights of its own: `layer use` chooses another, or its mask",
            wr_session_layer_name(session, index, &name));
    wr_text_fini(&name);
    return false;
}

bool wr_session_check_layer(const WrSession *session, WrError *err)
{
    const int active = session->state.document->active;
    return wr_session_check_unlocked(session, active, err) && check_shown(session, active, err) &&
           wr_session_check_heights(session, active, err);
}

WrLayer *wr_session_layer(WrSession *session, WrError *err)
{
    if (!wr_session_check_layer(session, err)) return NULL;
    return wr_document_edit_begin(session->state.document, &session->stand_in);
}

void wr_session_put_field(WrSession *session, WrField **field, WrField *made)
{
    const WrField *selection = session->state.document->selection;
    if (selection) {
        WrField *within = wr_edit_within(*field, made, selection);
        wr_field_free(made);
        made = within;
    }
    wr_field_free(*field);
    *field = made;
}

void wr_session_put_heights(WrSession *session, WrLayer *layer, WrField *heights)
{
    wr_session_put_field(session, &layer->heights, heights);
    wr_edit_mark(layer->cover, session->state.document->selection);
}

/* Value of a word of digits, or 0. */
static int layer_number(const char *word)
{
    size_t length = strlen(word);
    if (length == 0 || length > 6 || strspn(word, "0123456789") != length) return 0;
    return atoi(word);
}

bool wr_session_find_layer(const WrSession *session, const char *word, int *index, WrError *err)
{
    const WrDocument *document = session->state.document;
    char excerpt[WR_EXCERPT_SIZE];
    int number = layer_number(word), found = -1, same = 0;
    if (strspn(word, "0123456789") == strlen(word)) {
        if (number < 1 || number > document->layer_count)
            return wr_fail(err, "layer %s: must be 1..%d", wr_excerpt(word, excerpt),
                           document->layer_count);
        *index = number - 1;
        return true;
    }
    for (int i = 0; i < document->layer_count; i++)
        if (strcmp(document->layers[i].name, word) == 0) {
            found = i;
            same++;
        }
    if (same == 0)
        return wr_fail(err, "no layer is called \"%s\": must be a name or 1..%d",
                       wr_excerpt(word, excerpt), document->layer_count);
    if (same > 1)
        return wr_fail(err, "%d layers are called \"%s\": say which by its number", same,
                       wr_excerpt(word, excerpt));
    *index = found;
    return true;
}
