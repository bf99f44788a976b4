/* Storage of the dials that a tolerance chose, in a document. */
#include "command/session_internal.h"

#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <string.h>

void wr_session_keep_chosen(WrSession *session, const char *text)
{
    wr_free(session->state.chosen);
    session->state.chosen = text ? wr_strdup(text) : NULL;
    session->state.chosen_told = false;
}

const char *wr_session_chosen(const WrSession *session)
{
    return session->state.chosen;
}

static WrChoiceOrigin origin_of(const WrFrameRequest *request)
{
    WrText text = { 0 };
    wr_print_identity(request->scene, &text);
    const char *lines = wr_text_get(&text);
    const WrChoiceOrigin origin = { .table = wr_choice_tables_hash(request),
                                    .scene =
                                        wr_hash_bytes(lines, strlen(lines), (WrHash){ 0, 0 }) };
    wr_text_fini(&text);
    return origin;
}

const char *wr_chosen_recall(const char *kept, const WrFrameRequest *request, WrChoice *choice)
{
    if (!kept || wr_choice_fits(choice, request)) return NULL;
    const WrChoiceOrigin origin = origin_of(request);
    const char *misfit = wr_choice_misfit(kept, &origin, request);
    if (!misfit) wr_choice_read(kept, request, choice);
    return misfit;
}

void wr_chosen_write(const WrChoice *choice, const WrFrameRequest *request, WrText *text)
{
    const WrChoiceOrigin origin = origin_of(request);
    wr_choice_write(choice, &origin, text);
}

void wr_session_recall_chosen(WrSession *session, const WrFrameRequest *request)
{
    WrSessionState *state = &session->state;
    const char *misfit = wr_chosen_recall(state->chosen, request, &session->choice);
    if (misfit && !state->chosen_told) {
        wr_session_note(session,
                        "the document keeps dials that were chosen for another %s: chosen anew",
                        misfit);
        state->chosen_told = true;
    }
}

/* Dials of the last picture, if they still fit the document; else the stored ones. */
static void add_of(WrSession *session, const WrFrameRequest *request, WrText *text)
{
    const WrChoice *choice = &session->choice;
    const bool fresh = choice->count > 0 && choice->scene == request->scene &&
                       choice->tables_key == wr_choice_tables_key(request);
    if (!fresh && !session->state.chosen) return;
    const WrChoiceOrigin origin = origin_of(request);
    WrText chosen = { 0 };
    if (fresh) wr_choice_write(choice, &origin, &chosen);
    else if (wr_choice_is_for(session->state.chosen, &origin))
        wr_text_add(&chosen, session->state.chosen);
    if (chosen.length > 0) {
        wr_text_add(text, " chosen=");
        wr_text_add_word(text, wr_text_get(&chosen));
    }
    wr_text_fini(&chosen);
}

static void add_chosen(WrSession *session, WrText *text)
{
    const WrDocument *document = session->state.document;
    WrPool *pool = session->options.pool;
    if (document->scene->tolerance.kind == WR_TOLERANCE_NONE) return;
    WrTables *tables = wr_document_tables(document, document->scene, &session->table_cache, pool);
    const WrFrameRequest request = { .field = wr_document_composite(document, pool),
                                     .fields = wr_tables_fields(tables),
                                     .scene = document->scene };
    add_of(session, &request, text);
    wr_tables_free(tables);
}

/* Append the dials to the line of a tolerance. */
static void go_on(void *ctx, const WrCommand *command, WrText *text)
{
    if (!command->print_end) return;
    text->data[--text->length] = '\0';
    add_chosen(ctx, text);
    wr_text_add(text, "\n");
}

void wr_session_kept_text(WrSession *session, WrText *text)
{
    wr_print_scene(session->state.document->scene, go_on, (void *)session, text);
}
