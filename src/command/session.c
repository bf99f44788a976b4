#include "command/inner.h"

#include "base/file.h"
#include "base/memory.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void state_fini(WrSessionState *state)
{
    wr_document_free(state->document);
    for (int i = 0; i < state->history.count; i++) wr_free(state->history.data[i]);
    wr_array_free(&state->history);
    wr_free(state->path);
    *state = (WrSessionState){ 0 };
}

WrSession *wr_session_new(const WrSessionOptions *options)
{
    WrSession *session = wr_alloc(1, sizeof *session);
    if (options) session->options = *options;
    session->options.isa = wr_strdup(session->options.isa);
    session->state.document = wr_document_new();
    return session;
}

void wr_session_free(WrSession *session)
{
    if (!session) return;
    wr_session_stroke_cancel(session);
    state_fini(&session->state);
    wr_renderer_free(session->renderer);
    wr_free((char *)session->options.isa);
    wr_free(session);
}

void wr_session_set_outputs(WrSession *session, bool outputs)
{
    session->options.outputs = outputs;
}

void wr_session_note(WrSession *session, const char *format, ...)
{
    if (!session->options.note) return;
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    session->options.note(session->options.note_ctx, text);
}

/* ---- what commands change ---- */

WrField *wr_session_field(WrSession *session)
{
    return session->state.document->layers[0].field;
}

void wr_session_replace_field(WrSession *session, WrField *field)
{
    WrLayer *layer = &session->state.document->layers[0];
    wr_field_free(layer->field);
    layer->field = field;
}

void wr_session_replace_scene(WrSession *session, WrScene *scene)
{
    wr_scene_free(session->state.document->scene);
    session->state.document->scene = scene;
}

char *wr_session_input_path(const WrSession *session, const char *path)
{
    return wr_path_join(session->folder, path);
}

/* ---- running ---- */

static void remember(WrSession *session, const WrCall *call)
{
    WrText text = { 0 };
    wr_call_print(call, &text);
    wr_array_push(&session->state.history, wr_strdup(wr_text_get(&text)));
    session->state.revision++;
    wr_text_fini(&text);
}

static bool run_output(WrSession *session, WrCall *call, WrError *err)
{
    if (session->options.outputs && !session->skip_outputs)
        return call->command->run(session, call, err);
    WrText text = { 0 };
    wr_call_print(call, &text);
    wr_session_note(session, "skipped: %s (only `wrinkle run` writes files)", wr_text_get(&text));
    wr_text_fini(&text);
    return true;
}

static bool run_call(WrSession *session, WrCall *call, WrError *err)
{
    if (!call->command) return true;
    if (call->command->kind == WR_CLASS_OUTPUT) return run_output(session, call, err);
    WrDocument *before = wr_document_share(session->state.document);
    if (!call->command->run(session, call, err)) {
        wr_document_free(session->state.document);
        session->state.document = before;
        return false;
    }
    wr_document_free(before);
    remember(session, call);
    return true;
}

static bool refuse_in_stroke(const WrSession *session, WrError *err)
{
    if (!session->stroke) return true;
    return wr_fail(err, "a stroke is being drawn: it must end first");
}

/* Put the verb in front of a message that does not begin with it. */
static void name_command(WrError *err, const char *verb)
{
    size_t length = strlen(verb);
    if (err && (strncmp(err->text, verb, length) != 0 || isalnum((unsigned char)err->text[length])))
        wr_error_prefix(err, "%s: ", verb);
}

bool wr_session_run(WrSession *session, const char *line, WrError *err)
{
    WrCall *call;
    if (!refuse_in_stroke(session, err)) return false;
    if (!wr_call_parse(line, false, &call, err)) return false;
    bool good = run_call(session, call, err);
    if (!good) name_command(err, call->command->name);
    wr_call_free(call);
    return good;
}

/* ---- a stroke in progress ---- */

bool wr_session_stroke_begin(WrSession *session, const char *head, WrError *err)
{
    WrCall *call;
    if (!refuse_in_stroke(session, err)) return false;
    if (!wr_call_parse(head, true, &call, err)) return false;
    if (!call->command || strcmp(call->command->name, "stroke") != 0 ||
        wr_call_given(call, "points")) {
        wr_call_free(call);
        return wr_fail(err, "a stroke begins with a stroke command without points");
    }
    WrBrush brush = wr_call_brush(call);
    session->stroke_call = call;
    session->stroke_before = wr_document_share(session->state.document);
    session->stroke = wr_stroke_new(wr_session_field(session), &brush);
    return true;
}

/* The double that `value`, printed with that many decimals, reads back as: k / 10^n is correctly rounded
   because both are whole and below 2^53. */
static double round_decimals(double value, double ten_to_n)
{
    double k = rint(value * ten_to_n);
    return fabs(k) < 0x1p53 ? k / ten_to_n + 0.0 : value;
}

static double clamp_finite(double value, double low, double high)
{
    if (!(value >= low)) return isnan(value) ? 0 : low;
    return value > high ? high : value;
}

static WrSample round_sample(WrSample s)
{
    return (WrSample){ .u = round_decimals(s.u, 1e7),
                       .v = round_decimals(s.v, 1e7),
                       .pressure = round_decimals(clamp_finite(s.pressure, 0, 1), 1e4),
                       .tilt_x = round_decimals(clamp_finite(s.tilt_x, -1, 1), 1e4),
                       .tilt_y = round_decimals(clamp_finite(s.tilt_y, -1, 1), 1e4),
                       .seconds = round_decimals(clamp_finite(s.seconds, 0, 1e9), 1e4) };
}

bool wr_session_stroke_add(WrSession *session, const WrSample *samples, int count, WrError *err)
{
    if (!session->stroke) return wr_fail(err, "no stroke is being drawn");
    for (int i = 0; i < count; i++)
        if (!(fabs(samples[i].u) <= 1e9) || !(fabs(samples[i].v) <= 1e9))
            return wr_fail(err, "stroke: sample %d is at %g,%g: must be within 1e9 of 0", i + 1,
                           samples[i].u, samples[i].v);
    if (count > WR_POINTS_MAX - wr_call_arg(session->stroke_call, "points")->rows)
        return wr_fail(err, "stroke: more than %d samples", WR_POINTS_MAX);
    for (int i = 0; i < count; i++) {
        WrSample s = round_sample(samples[i]);
        double row[6] = { s.u, s.v, s.pressure, s.tilt_x, s.tilt_y, s.seconds };
        int n = s.seconds != 0 ? 6 : s.tilt_x != 0 || s.tilt_y != 0 ? 5 : s.pressure != 1 ? 3 : 2;
        wr_call_add_row(session->stroke_call, "points", row, n);
        wr_stroke_add(session->stroke, s);
    }
    return true;
}

/* Close the open stroke; the caller has seen to the document. */
static void drop_stroke(WrSession *session)
{
    wr_stroke_free(session->stroke);
    wr_call_free(session->stroke_call);
    wr_document_free(session->stroke_before);
    session->stroke = NULL;
    session->stroke_call = NULL;
    session->stroke_before = NULL;
}

bool wr_session_stroke_end(WrSession *session, WrError *err)
{
    if (!session->stroke) return wr_fail(err, "no stroke is being drawn");
    if (wr_call_given(session->stroke_call, "points")) remember(session, session->stroke_call);
    drop_stroke(session);
    return true;
}

void wr_session_stroke_cancel(WrSession *session)
{
    if (!session->stroke) return;
    wr_stroke_free(session->stroke); /* before the field that it draws on */
    session->stroke = NULL;
    wr_document_free(session->state.document);
    session->state.document = session->stroke_before;
    session->stroke_before = NULL;
    drop_stroke(session);
}

bool wr_session_in_stroke(const WrSession *session)
{
    return session->stroke != NULL;
}

/* ---- what a session tells ---- */

const WrDocument *wr_session_document(const WrSession *session)
{
    return session->state.document;
}

int wr_session_history_count(const WrSession *session)
{
    return session->state.history.count;
}

const char *wr_session_history_line(const WrSession *session, int index)
{
    if (index < 0 || index >= session->state.history.count) return "";
    return session->state.history.data[index];
}

const char *wr_session_last_command(const WrSession *session)
{
    return wr_session_history_line(session, session->state.history.count - 1);
}

uint64_t wr_session_revision(const WrSession *session)
{
    return session->state.revision;
}

uint64_t wr_session_saved_revision(const WrSession *session)
{
    return session->state.saved_revision;
}

const char *wr_session_path(const WrSession *session)
{
    return session->state.path ? session->state.path : "";
}

void wr_session_scene_text(const WrSession *session, WrText *text)
{
    for (int i = 0; i < wr_command_count; i++)
        if (wr_commands[i].print) wr_commands[i].print(session->state.document->scene, text);
}

WrHash wr_session_hash(const WrSession *session)
{
    WrText text = { 0 };
    wr_session_scene_text(session, &text);
    WrHash hash = wr_document_hash(session->state.document, wr_text_get(&text));
    wr_text_fini(&text);
    return hash;
}

/* ---- replacing the document as a whole ---- */

WrSessionState wr_session_begin_state(WrSession *session, WrDocument *document)
{
    WrSessionState old = session->state;
    session->state = (WrSessionState){ .document = document, .revision = old.revision };
    return old;
}

void wr_session_keep_state(WrSession *session, WrSessionState *old)
{
    state_fini(old);
    session->state.revision++;
    session->state.saved_revision = session->state.revision;
}

void wr_session_restore_state(WrSession *session, WrSessionState *old)
{
    state_fini(&session->state);
    session->state = *old;
}

void wr_session_reset(WrSession *session)
{
    wr_session_stroke_cancel(session);
    WrSessionState old = wr_session_begin_state(session, wr_document_new());
    wr_session_keep_state(session, &old);
}
