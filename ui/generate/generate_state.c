/* The current generator: its values, its command line and its preview. */
#include "ui/generate/generate_state.h"
#include "ui/canvas/view.h"
#include "ui/state/action_list.h"
#include "ui/state/busy.h"
#include "ui/state/app_state.h"
#include "ui/state/dialog.h"
#include "ui/state/input_router.h"
#include "ui/state/roster.h"
#include "ui/state/session_view.h"
#include "ui/tools/tool.h"
#include "ui/jobs/edit_preview.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/generate.h"
#include "command/session.h"
#include "generate/generator.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PATIENCE_SECONDS 0.25 /* an outdated result that is due this soon is still awaited */
#define QUICK_SECONDS 0.12    /* slower generators show a rough result first */
#define LARGE_TEXELS 1e6      /* before any measurement: larger tables show a rough result first */

void wr_generate_new(WrApp *app)
{
    app->generate = wr_alloc(1, sizeof *app->generate);
    app->generate->preset = -2;
    app->generate->point = app->generate->blamed = -1;
}

void wr_generate_free(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    if (!hand) return;
    wr_generate_free_values(hand);
    for (int i = 0; i < hand->kept.count; i++) wr_free(hand->kept.data[i]);
    for (int i = 0; i < hand->presets.count; i++) {
        wr_free(hand->presets.data[i].name);
        wr_free(hand->presets.data[i].line);
    }
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
    size_t family = hand->generator ? strlen(hand->generator->family) : 0;
    hand->blamed = -1;
    hand->blame = 0;
    if (!colon || strncmp(said, hand->generator->family, family) != 0) return;
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
    wr_generate_free_values(hand);
    hand->generator = generator;
    hand->seconds = 0.0;
    hand->held = WR_POSE_NONE;
    wr_generate_defaults(app);
}

void wr_generate_focus_text(WrApp *app)
{
    app->generate->focus_text = WR_GENERATE_WAKE; /* the panel may not have been visible */
    app->redraw = WR_GENERATE_WAKE;
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
    hand->opened++;
    wr_tab_show(app, "Generate");
    app->hints = false;
    if (wr_generate_written(generator) >= 0) wr_generate_focus_text(app);
    wr_generate_changed(app);
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
    wr_app_try(app, &(WrEditPreviewRequest){ .line = line, .rough = slow });
}

/* True if a result, even an outdated one, will be ready soon. It is then shown first, so that a continuously dragged
   slider does not suppress all previews. */
static bool is_awaited(WrApp *app)
{
    double seconds;
    return app->trying && wr_edit_preview_busy(app->trial, NULL, &seconds) &&
           !wr_edit_preview_rough(app->trial) && seconds < PATIENCE_SECONDS;
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

void wr_generate_update(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    WrText line = { 0 };
    if (!hand->active || !hand->generator || app->dialog->now != WR_DIALOG_NONE ||
        wr_app_line_waits(app))
        return;
    if (app->trying && hand->asked) look(app);
    wr_generate_line(hand, &line);
    bool same = app->trying && hand->asked && strcmp(hand->asked, wr_text_get(&line)) == 0 &&
                hand->asked_at == wr_session_revision(app->session);
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
    wr_app_redraw(app);
}

void wr_generate_commit(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    WrText line = { 0 };
    if (!hand->generator || wr_busy_refuse(app)) return;
    wr_generate_line(hand, &line);
    hand->active = false;
    hand->held = WR_POSE_NONE;
    app->hand->grab = WR_GRAB_NONE;
    app->hints = false;
    bool tried = app->trying && hand->asked && strcmp(hand->asked, wr_text_get(&line)) == 0 &&
                 hand->asked_at == wr_session_revision(app->session);
    if (tried) wr_app_run_tried(app, wr_text_get(&line));
    else wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

bool wr_generate_writes(const WrApp *app)
{
    const WrGenerateState *hand = app->generate;
    return hand->active && hand->generator && wr_generate_written(hand->generator) >= 0;
}

bool wr_generate_by_name(WrApp *app, const char *name)
{
    const WrGenerator *generator = wr_action_generator(name);
    if (generator) wr_generate_open(app, generator);
    return generator != NULL;
}

const WrPart wr_part_generate = { .update = wr_generate_update };
