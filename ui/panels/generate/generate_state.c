/* The current generator: its values, its command line and its preview. */
#include "ui/panels/generate/generate_state.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/canvas/view.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/canvas/tools/tool.h"
#include "ui/app/jobs/edit_preview.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "command/session.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "generate/generator.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- conversion between the values of the current generator and its command line ---- */

static const char action_prefix[] = "generate_";

static void generate_free_values(WrGenerateState *hand)
{
    for (int i = 0; i < WR_GENERATOR_PARAMS; i++) wr_free(hand->value[i].text);
    memset(hand->value, 0, sizeof hand->value);
}

/* ---- names ---- */

void wr_generate_action(const WrGenerator *generator, char name[WR_GENERATE_ACTION])
{
    const char *form = generator->name;
    snprintf(name, WR_GENERATE_ACTION, "%s%.24s%s%.24s", action_prefix, generator->family,
             form ? "_" : "", form ? form : "");
}

const WrGenerator *wr_action_generator(const char *name)
{
    char own[WR_GENERATE_ACTION];
    if (strncmp(name, action_prefix, sizeof action_prefix - 1) != 0) return NULL;
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            wr_generate_action(g, own);
            if (strcmp(own, name) == 0) return g;
        }
    return NULL;
}

int wr_generate_find(const WrGenerateState *hand, const char *const *names, WrParamKind kind)
{
    for (; hand->generator && *names; names++) {
        int i = wr_generator_param_find(hand->generator, *names);
        if (i >= 0 && hand->generator->params[i].kind == kind) return i;
    }
    return -1;
}

int wr_generate_written(const WrGenerator *generator)
{
    for (int i = 0; generator->params[i].name; i++) {
        const WrParam *p = &generator->params[i];
        const bool optional = p->fallback_text && !p->fallback_text[0];
        if (p->kind == WR_PARAM_TEXT && !p->layer && !optional) return i;
    }
    return -1;
}

static bool is_written(WrParamKind kind)
{
    return kind == WR_PARAM_TEXT || kind == WR_PARAM_FILE || kind == WR_PARAM_POINTS ||
           kind == WR_PARAM_TERMS;
}

/* ---- values ---- */

void wr_generate_set_text(WrGenerateValue *value, const char *text)
{
    if (!value->text) value->text = wr_alloc(1, WR_GENERATE_TEXT);
    SDL_utf8strlcpy(value->text, text, WR_GENERATE_TEXT);
}

/* Default text for terms, which have none: an example. */
static void first_term(const WrParam *p, WrText *text)
{
    for (int k = 0; k < p->fewest; k++) {
        const WrParamPart *part = &p->parts[k];
        double wanted = part->whole ? 1.0 : 0.5;
        if (k > 0) wr_text_add(text, ",");
        wr_text_add_number(text, fmin(fmax(wanted, part->low), part->high));
    }
}

static void set_default(WrGenerateState *hand, int i)
{
    const WrParam *p = &hand->generator->params[i];
    WrText text = { 0 };
    memcpy(hand->value[i].number, p->fallback, sizeof p->fallback);
    if (p->kind == WR_PARAM_TERMS) first_term(p, &text);
    else if (p->fallback_text) wr_text_add(&text, p->fallback_text);
    else if (p->kind == WR_PARAM_TEXT) wr_text_add(&text, "Wrinkle");
    if (is_written(p->kind)) wr_generate_set_text(&hand->value[i], wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_generate_defaults(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    for (int i = 0; hand->generator->params[i].name; i++) set_default(hand, i);
    hand->blend = wr_blend_find(hand->generator->blend);
    hand->radius = 0.1;
    hand->offset = 0.0;
    hand->preset = -1;
}

/* Text of a parsed argument in command syntax. */
static bool take_written(WrGenerateValue *value, const WrCall *call, const WrParam *p)
{
    WrText text = { 0 };
    const WrArg *arg = wr_call_arg(call, p->name);
    if (p->kind == WR_PARAM_TEXT && arg->text) {
        char *lines = wr_generator_text(arg->text);
        wr_text_add(&text, lines);
        wr_free(lines);
    } else if (p->kind == WR_PARAM_FILE && arg->text) {
        wr_text_add(&text, arg->text);
    } else if (arg->given) {
        wr_arg_print(&call->specs[arg - call->args], arg, &text);
    }
    bool fits = text.length < WR_GENERATE_TEXT;
    if (fits) wr_generate_set_text(value, wr_text_get(&text));
    wr_text_fini(&text);
    return fits;
}

static bool take_values(WrApp *app, const WrCall *call, const WrGenerator *generator, WrError *err)
{
    WrGenerateState *hand = app->generate;
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generate_take(app, generator);
    wr_call_values(call, generator, values);
    for (int i = 0; generator->params[i].name; i++) {
        const WrParam *p = &generator->params[i];
        memcpy(hand->value[i].number, values[i].number, sizeof values[i].number);
        if (is_written(p->kind) && !take_written(&hand->value[i], call, p))
            return wr_fail(err, "%s: too long for the panel", p->label);
    }
    hand->blend = wr_call_choice(call, wr_generator_argument(generator, "blend"));
    hand->radius = wr_call_number(call, wr_generator_argument(generator, "radius"));
    hand->offset = wr_call_number(call, wr_generator_argument(generator, "offset"));
    return true;
}

bool wr_generate_load(WrApp *app, const char *line)
{
    WrCall *call = NULL;
    WrError err;
    bool good = wr_call_parse(line, false, &call, &err);
    const WrGenerator *generator = good ? wr_call_generator(call) : NULL;
    if (good && !generator) good = wr_fail(&err, "not the command of a generator: %.80s", line);
    good = good && take_values(app, call, generator, &err);
    if (!good) wr_app_fail(app, &err);
    wr_call_free(call);
    return good;
}

/* ---- the line ---- */

/* Append the text in quotes. */
static void add_quoted(WrText *line, const char *word, bool lines)
{
    wr_text_add(line, "\"");
    for (const char *c = word; *c; c++) {
        if (*c == '\r') continue; /* from pasted text */
        /* escaped twice: for the text, and for the quotes */
        bool turn = lines && (*c == '\n' || *c == '\\');
        if (*c == '"' || *c == '\\' || turn) wr_text_add(line, "\\");
        if (turn) wr_text_add(line, *c == '\n' ? "\\n" : "\\\\\\");
        else wr_text_add_n(line, c, 1);
    }
    wr_text_add(line, "\"");
}

static void add_value(WrText *line, const WrParam *p, const WrGenerateValue *value)
{
    int count = p->kind == WR_PARAM_TUPLE ? p->components : 1;
    wr_text_add(line, " ");
    if (!p->positional) wr_text_addf(line, "%s=", p->name);
    if (p->kind == WR_PARAM_TEXT || p->kind == WR_PARAM_FILE) {
        add_quoted(line, value->text, p->kind == WR_PARAM_TEXT);
    } else if (is_written(p->kind) && strpbrk(value->text, "#\"\\")) {
        add_quoted(line, value->text, false); /* invalid numbers, but the line must stay intact */
    } else if (is_written(p->kind)) {
        for (const char *c = value->text; *c; c++) /* blanks would end the value */
            if (*c != ' ' && *c != '\t') wr_text_add_n(line, c, 1);
    } else if (p->kind == WR_PARAM_CHOICE) {
        wr_text_add(line, p->words[(int)value->number[0]]);
    } else if (p->kind == WR_PARAM_SWITCH) {
        wr_text_add(line, value->number[0] != 0.0 ? "on" : "off");
    } else {
        for (int k = 0; k < count; k++) {
            if (k > 0) wr_text_add(line, ",");
            wr_text_add_number(line, value->number[k]);
        }
    }
}

static bool is_default(const WrParam *p, const WrGenerateValue *value)
{
    int count = p->kind == WR_PARAM_TUPLE ? p->components : 1;
    if (p->kind == WR_PARAM_TEXT || p->kind == WR_PARAM_FILE)
        return p->fallback_text ? strcmp(value->text, p->fallback_text) == 0 : !value->text[0];
    if (is_written(p->kind)) return !value->text[strspn(value->text, " \t")];
    for (int k = 0; k < count; k++)
        if (value->number[k] != p->fallback[k]) return false;
    return true;
}

bool wr_generate_param_is_default(const WrGenerateState *hand, int param)
{
    return is_default(&hand->generator->params[param], &hand->value[param]);
}

void wr_generate_line(const WrGenerateState *hand, WrText *line)
{
    const WrGenerator *g = hand->generator;
    wr_text_add(line, g->family);
    if (g->name) wr_text_addf(line, " %s", g->name);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; g->params[i].name; i++) {
            const WrParam *p = &g->params[i];
            bool stated = !is_default(p, &hand->value[i]) ||
                          (p->positional && !(is_written(p->kind) && !hand->value[i].text[0]));
            if (p->positional == (pass == 0) && stated) add_value(line, p, &hand->value[i]);
        }
    if (hand->blend != wr_blend_find(g->blend))
        wr_text_addf(line, " %s=%s", wr_generator_argument(g, "blend"),
                     wr_blends[hand->blend].name);
    if (wr_blends[hand->blend].uses_radius && hand->radius != 0.1)
        wr_line_number(line, wr_generator_argument(g, "radius"), hand->radius);
    if (hand->offset != 0.0) wr_line_number(line, wr_generator_argument(g, "offset"), hand->offset);
}

void wr_generate_default_line(const WrGenerator *generator, const char *written, WrText *line)
{
    WrGenerateState hand = { .generator = generator,
                             .blend = wr_blend_find(generator->blend),
                             .radius = 0.1 };
    int text = wr_generate_written(generator);
    for (int i = 0; generator->params[i].name; i++) set_default(&hand, i);
    if (text >= 0 && !generator->params[text].fallback_text)
        wr_generate_set_text(&hand.value[text], written);
    wr_generate_line(&hand, line);
    generate_free_values(&hand);
}

/* ---- creation and destruction ---- */

#define PATIENCE_SECONDS 0.25 /* an outdated result that is due this soon is still awaited */
#define QUICK_SECONDS 0.12    /* slower generators show a rough result first */
#define LARGE_TEXELS 1e6      /* before any measurement: larger tables show a rough result first */

void wr_generate_new(WrApp *app)
{
    app->generate = wr_alloc(1, sizeof *app->generate);
    app->generate->preset = -2;
    app->generate->layer = -1;
    app->generate->point = app->generate->blamed = -1;
}

void wr_generate_free(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    if (!hand) return;
    generate_free_values(hand);
    for (int i = 0; i < hand->kept.count; i++) wr_free(hand->kept.data[i]);
    wr_generate_presets_forget(hand);
    wr_array_free(&hand->kept);
    wr_array_free(&hand->presets);
    wr_free(hand->asked);
    wr_free(hand);
    app->generate = NULL;
}

/* ---- errors ---- */

/* Messages are "GENERATOR: NAME=VALUE: remedy", "GENERATOR: NAME is missing ..." or "GENERATOR: FILE: fault of the
   file". */
void wr_generate_blame(WrGenerateState *hand)
{
    const char *said = hand->err.text, *colon = strstr(said, ": ");
    hand->blamed = -1;
    hand->blame = 0;
    if (!colon || !hand->generator) return;
    const char *family = hand->generator->family;
    if (strncmp(said, family, strlen(family)) != 0) return;
    said = colon + 2;
    hand->blame = (size_t)(said - hand->err.text);
    for (int i = 0; hand->generator->params[i].name; i++) {
        const WrParam *p = &hand->generator->params[i];
        const char *file = p->kind == WR_PARAM_FILE ? hand->value[i].text : "";
        size_t name = strlen(p->name), length = strlen(file);
        bool named = strncmp(said, p->name, name) == 0 && strchr("=: ", said[name]);
        bool held = length > 0 && strncmp(said, file, length) == 0 && said[length] == ':';
        if (!named && !held) continue;
        hand->blamed = i;
        return;
    }
}

/* ---- choice of a generator ---- */

static bool is_of(const char *line, const WrGenerator *generator)
{
    WrCall *call = NULL;
    WrError err;
    bool good = wr_call_parse(line, false, &call, &err) && wr_call_generator(call) == generator;
    wr_call_free(call);
    return good;
}

static int find_kept(const WrGenerateState *hand, const WrGenerator *generator)
{
    for (int i = 0; i < hand->kept.count; i++)
        if (is_of(hand->kept.data[i], generator)) return i;
    return -1;
}

static void keep(WrGenerateState *hand)
{
    WrText line = { 0 };
    if (!hand->generator) return;
    wr_generate_line(hand, &line);
    int i = find_kept(hand, hand->generator);
    if (i < 0) {
        wr_array_push(&hand->kept, NULL);
        i = hand->kept.count - 1;
    }
    wr_free(hand->kept.data[i]);
    hand->kept.data[i] = wr_strdup(wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_generate_take(WrApp *app, const WrGenerator *generator)
{
    WrGenerateState *hand = app->generate;
    if (hand->generator == generator) return;
    keep(hand);
    generate_free_values(hand);
    hand->generator = generator;
    hand->seconds = 0.0;
    hand->held = WR_POSE_NONE;
    hand->point = -1;
    wr_generate_defaults(app);
}

void wr_generate_focus_text(WrApp *app)
{
    app->generate->focus_text = WR_GENERATE_WAKE; /* the panel may not have been visible */
    app->redraw = WR_GENERATE_WAKE;
}

static void show(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    hand->opened++;
    wr_tab_show(app, "Generate");
    app->hints = false;
    if (wr_generate_written(hand->generator) >= 0) wr_generate_focus_text(app);
    wr_generate_changed(app);
}

/* The layer's mode and radius are those of its line. */
void wr_generate_edit_layer(WrApp *app, int index)
{
    WrGenerateState *hand = app->generate;
    const WrLayer *layer = &wr_app_document(app)->layers[index];
    if (!layer->line || !wr_generate_load(app, layer->line)) return;
    hand->layer = index;
    hand->blend = (int)layer->blend;
    hand->radius = (double)layer->radius;
    show(app);
}

void wr_generate_open(WrApp *app, const WrGenerator *generator)
{
    WrGenerateState *hand = app->generate;
    if (hand->generator != generator) {
        int kept = find_kept(hand, generator);
        char *line = kept >= 0 ? wr_strdup(hand->kept.data[kept]) : NULL;
        if (line) wr_generate_load(app, line);
        else wr_generate_take(app, generator);
        wr_free(line);
    }
    show(app);
}

const WrGenerator *wr_generate_last(const WrApp *app)
{
    const WrGenerator *generator = app->generate->generator;
    for (const WrFamily *f = wr_families; !generator && f->name; f++)
        if (f->rows->family) generator = f->rows;
    return generator;
}

void wr_generate_open_last(WrApp *app)
{
    wr_generate_open(app, wr_generate_last(app));
}

void wr_generate_changed(WrApp *app)
{
    int tool = wr_tool_find(app, WR_ACT(generate));
    if (app->tool != tool) wr_tool_choose(app, tool); /* choosing a tool ends a drag */
    app->generate->active = true;
    wr_app_redraw(app);
}

void wr_generate_file(WrApp *app, const char *path)
{
    WrGenerateState *hand = app->generate;
    if (!hand->generator || hand->asking_file >= wr_generator_param_count(hand->generator)) return;
    if (hand->generator->params[hand->asking_file].kind != WR_PARAM_FILE) return;
    wr_generate_set_text(&hand->value[hand->asking_file], path);
    wr_generate_changed(app);
}

/* ---- preview ---- */

/* The edge of a mask is that of the active layer's: a new layer has none. */
static bool reads_own_mask(const WrGenerateState *hand)
{
    const int of = hand->generator ? wr_generator_param_find(hand->generator, "of") : -1;
    const char *const *words = of >= 0 ? hand->generator->params[of].words : NULL;
    return words && strcmp(words[(int)hand->value[of].number[0]], "mask") == 0;
}

WrLineTarget wr_generate_target(const WrGenerateState *hand)
{
    if (hand->layer >= 0) return WR_LINE_OF_LAYER;
    return hand->into_active || reads_own_mask(hand) ? WR_LINE_INTO_ACTIVE : WR_LINE_NEW_LAYER;
}

/* True if the preview shows this line in the present document. */
static bool is_asked(const WrApp *app, const char *line)
{
    const WrGenerateState *hand = app->generate;
    return app->trying && hand->asked && strcmp(hand->asked, line) == 0 &&
           hand->asked_into == wr_generate_target(hand) &&
           hand->asked_at == wr_session_revision(app->session);
}

static void ask(WrApp *app, const char *line)
{
    WrGenerateState *hand = app->generate;
    double texels = (double)app->view->table_w * app->view->table_h;
    bool slow = hand->seconds > 0.0 ? hand->seconds > QUICK_SECONDS : texels > LARGE_TEXELS;
    char *copy = wr_strdup(line);
    wr_free(hand->asked);
    hand->asked = copy;
    hand->asked_of = hand->generator;
    hand->asked_at = wr_session_revision(app->session);
    WrEditPreviewRequest request = { .line = line,
                                     .target = wr_generate_target(hand),
                                     .rough = slow };
    if (hand->layer >= 0) {
        request.layer = hand->layer;
        request.blend = (WrBlend)hand->blend;
        request.radius = (float)hand->radius;
        request.opacity = wr_app_document(app)->layers[hand->layer].opacity;
    }
    hand->asked_into = request.target;
    wr_app_try(app, &request);
}

/* True if a result, even an outdated one, will be ready soon. It is then shown first, so that a continuously dragged
   slider does not suppress all previews. */
static bool is_awaited(WrApp *app)
{
    double seconds;
    return app->trying && wr_edit_preview_busy(app->trial, NULL, &seconds) &&
           !wr_edit_preview_is_rough(app->trial) && seconds < PATIENCE_SECONDS;
}

static void look(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    WrError err;
    if (wr_edit_preview_error(app->trial, &err)) {
        hand->err = err;
        /* A result of another generator must not stay visible. */
        if (hand->seconds == 0.0) wr_edit_preview_end(app->trial);
        wr_app_redraw(app);
    } else if (hand->asked_of == hand->generator && !wr_edit_preview_busy(app->trial, NULL, NULL) &&
               wr_edit_preview_field(app->trial)) {
        hand->seconds = wr_edit_preview_seconds(app->trial);
    }
}

/* The edited layer may be gone, by undo or by another command. */
static bool layer_stands(const WrApp *app)
{
    const WrGenerateState *hand = app->generate;
    const WrDocument *document = wr_app_document(app);
    return hand->layer < 0 ||
           (hand->layer < document->layer_count && document->layers[hand->layer].line);
}

/* ---- component ---- */

static void generate_update(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    WrText line = { 0 };
    if (!hand->active || !hand->generator || app->dialog->now != WR_DIALOG_NONE ||
        wr_app_line_waits(app))
        return;
    if (app->trying && hand->asked) look(app);
    if (!layer_stands(app)) app->generate->layer = -1;
    wr_generate_line(hand, &line);
    const bool same = is_asked(app, wr_text_get(&line));
    if (!same && !wr_session_in_stroke(app->session) && !is_awaited(app)) {
        hand->err.text[0] = '\0';
        ask(app, wr_text_get(&line));
    }
    wr_text_fini(&line);
}

void wr_generate_cancel(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    if (hand->active && app->dialog->now == WR_DIALOG_NONE) wr_app_try_end(app);
    hand->active = false;
    hand->held = WR_POSE_NONE;
    hand->err.text[0] = '\0';
    app->generate->layer = -1;
    wr_app_redraw(app);
}

/* The command that carries out `line`, a generator's. */
static void add_command(const WrApp *app, const char *line, WrText *text)
{
    const WrGenerateState *hand = app->generate;
    char number[WR_NUMBER_SIZE];
    switch (wr_generate_target(hand)) {
    case WR_LINE_INTO_ACTIVE: wr_text_add(text, line); return;
    case WR_LINE_NEW_LAYER:
        wr_text_add(text, "layer add ");
        wr_generate_add_name(app, line, text);
        break;
    case WR_LINE_OF_LAYER: wr_text_addf(text, "layer set %d", hand->layer + 1); break;
    }
    wr_text_add(text, " from=");
    wr_text_add_word(text, line);
    if (hand->layer < 0) return;
    wr_generate_follow_name(app, hand->layer, line, text);
    wr_text_addf(text, " blend=%s radius=%s", wr_blends[hand->blend].name,
                 wr_number_print(hand->radius, number));
}

/* A path is drawn for one layer: the next text would lie exactly on this one. */
static void forget_points(WrGenerateState *hand)
{
    for (int i = 0; hand->generator->params[i].name; i++)
        if (hand->generator->params[i].kind == WR_PARAM_POINTS)
            wr_generate_set_text(&hand->value[i], "");
}

void wr_generate_commit(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    WrText line = { 0 }, command = { 0 };
    if (!hand->generator || wr_busy_refuse(app)) return;
    wr_generate_line(hand, &line);
    add_command(app, wr_text_get(&line), &command);
    const bool tried = is_asked(app, wr_text_get(&line));
    hand->active = false;
    hand->held = WR_POSE_NONE;
    app->generate->layer = -1;
    app->hand->grab = WR_GRAB_NONE;
    app->hints = false;
    if (tried) wr_app_run_tried(app, wr_text_get(&command));
    else wr_app_run_slow(app, wr_text_get(&command));
    forget_points(hand);
    wr_text_fini(&line);
    wr_text_fini(&command);
}

bool wr_generate_writes(const WrApp *app)
{
    const WrGenerateState *hand = app->generate;
    return hand->active && hand->generator && wr_generate_written(hand->generator) >= 0;
}

bool wr_generate_tab_of_action(WrApp *app, const char *name)
{
    const WrGenerator *generator = wr_action_generator(name);
    if (generator) app->generate->layer = -1;
    if (generator) wr_generate_open(app, generator);
    return generator != NULL;
}

const WrPart wr_part_generate = { .update = generate_update };
