/* History commands: script, undo, redo, view, history. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/scene.h"
#include "system/path.h"

#include <string.h>

/* Goes there, and back again if the making of the composite is cancelled. */
static bool travel(WrSession *session, int steps, WrError *err)
{
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    wr_session_travel(session, steps);
    if (wr_session_make_composite(session, err)) return true;
    wr_session_travel(session, -steps);
    return false;
}

static bool run_undo(WrSession *session, WrCall *call, WrError *err)
{
    const int steps = (int)wr_call_number(call, "N"), most = wr_session_undo_count(session);
    const bool all = wr_session_history_oldest(session) == 0;
    if (most == 0 && all) return wr_fail(err, "nothing to undo");
    if (steps > most)
        return wr_fail(err, "%d steps: %d can be undone%s", steps, most,
                       all ? "" : "; older states were given up to keep the history in its budget");
    return travel(session, -steps, err);
}

static bool run_redo(WrSession *session, WrCall *call, WrError *err)
{
    const int steps = (int)wr_call_number(call, "N"), most = wr_session_redo_count(session);
    if (most == 0) return wr_fail(err, "nothing to redo");
    if (steps > most) return wr_fail(err, "%d steps: %d can be redone", steps, most);
    return travel(session, steps, err);
}

static bool run_history(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    if (wr_call_given(call, "budget"))
        wr_session_set_history_budget(session, (size_t)wr_call_number(call, "budget"));
    wr_session_note(session, "%d steps can be undone, %d redone; they take %.1f of %.1f MB",
                    wr_session_undo_count(session), wr_session_redo_count(session),
                    (double)wr_session_history_bytes(session) / 1e6,
                    (double)wr_session_history_budget(session) / 1e6);
    return true;
}

/* ---- as a script ---- */

/* `path` relative to a script in folder `home` (absolute; "" if unknown). Points into path. */
static const char *seen_from(const char *home, const char *path)
{
    size_t length = strlen(home);
    bool below = length > 0 && strncmp(path, home, length) == 0 && path[length] == '/';
    return below ? path + length + 1 : path;
}

typedef struct Script {
    WrText text;
    const char *home;   /* folder of the script */
    const char *folder; /* of the present line; NULL: the current one */
} Script;

static void shorten_names(WrCall *call, void *ctx)
{
    const Script *script = ctx;
    for (int i = 0; i < call->count; i++) {
        const char *hash = wr_call_hash_argument(call, i);
        if (!hash || !wr_call_given(call, hash) || !wr_call_names_file(call, i)) continue;
        char *full = wr_path_join(script->folder ? script->folder : ".", call->args[i].text);
        wr_call_set_text(call, call->specs[i].name, seen_from(script->home, full));
        wr_free(full);
    }
}

/* Print a line; files that were read have a checksum, and their paths become relative to the script. */
static void add_line(void *ctx, const char *line, const char *folder)
{
    Script *script = ctx;
    WrText *text = &script->text;
    WrCall *call = NULL;
    if (!wr_call_parse(line, false, &call, NULL)) { /* impossible: the line has run */
        wr_text_addf(text, "%s\n", line);
        return;
    }
    script->folder = folder;
    wr_call_visit(call, shorten_names, script);
    wr_call_print(call, text);
    wr_text_add(text, "\n");
    wr_call_free(call);
}

bool wr_session_save_history(WrSession *session, const char *path, WrError *err)
{
    char *folder = wr_path_folder(path), *real = wr_path_real(folder);
    Script script = { .home = real ? real : "" };
    if (session->state.origin) add_line(&script, session->state.origin, NULL);
    wr_session_lines(session, add_line, &script);
    bool good = wr_file_write(path, wr_text_get(&script.text), script.text.length, err);
    free(real);
    wr_free(folder);
    wr_text_fini(&script.text);
    return good;
}

/* Only the listed steps in force, as a macro. */
static bool save_steps(WrSession *session, const char *path, const char *steps, WrError *err)
{
    const WrHistory *history = session->state.history;
    char *folder = wr_path_folder(path), *real = wr_path_real(folder);
    Script script = { .home = real ? real : "" };
    for (int i = 0; i < wr_history_position(history); i++)
        if (wr_step_listed(steps, i + 1) && !wr_history_is_off(history, i))
            add_line(&script, wr_history_line(history, i), wr_history_folder(history, i));
    const bool good =
        (script.text.length || wr_fail(err, "steps=%s: all of them are undone or off", steps)) &&
        wr_file_write(path, wr_text_get(&script.text), script.text.length, err);
    free(real);
    wr_free(folder);
    wr_text_fini(&script.text);
    return good;
}

static bool run_script(WrSession *session, WrCall *call, WrError *err)
{
    const char *path = wr_call_arg(call, "FILE")->text, *steps = wr_call_arg(call, "steps")->text;
    if (!steps) return wr_session_save_history(session, path, err);
    return save_steps(session, path, steps, err);
}

static bool run_view(WrSession *session, WrCall *call, WrError *err)
{
    WrViews *views = session->state.views;
    bool back = strcmp(call->form_name, "back") == 0;
    int steps = (int)wr_call_number(call, "N");
    int most = back ? wr_views_back(views) : wr_views_forward(views);
    if (most == 0) return wr_fail(err, "there is no view %s this one", back ? "before" : "after");
    if (steps > most) return wr_fail(err, "%d views: there are %d", steps, most);
    WrSceneView view = wr_views_go(views, back ? -steps : steps);
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_set_pose(scene, &view);
    wr_session_replace_scene(session, scene);
    wr_history_record_view(session->state.history, session->state.document);
    return true;
}

static void put_lines(const char *text, WrLineSink *sink, void *ctx)
{
    for (const char *p = text; *p;) {
        size_t length = strcspn(p, "\n");
        char *line = wr_strndup(p, length);
        sink(ctx, line, NULL);
        wr_free(line);
        p += length + 1;
    }
}

/* Send the lines that set `view`. */
static void put_view(const WrSceneView *view, WrLineSink *sink, void *ctx)
{
    WrText text = { 0 };
    WrScene *scene = wr_scene_new();
    wr_scene_set_pose(scene, view);
    if (view->of_one && !view->posed) wr_text_add(&text, "rotate pose=own\n");
    wr_print_rotate(scene, &text);
    wr_print_camera(scene, &text);
    put_lines(wr_text_get(&text), sink, ctx);
    wr_scene_free(scene);
    wr_text_fini(&text);
}

/* A view line is needed at the end, and before a step that changes the view, since undoing that step restores the
   earlier view. Dropped states are never restored. */
void wr_session_lines(const WrSession *session, WrLineSink *sink, void *ctx)
{
    const WrHistory *history = session->state.history;
    int position = wr_history_position(history);
    WrSceneView now = wr_views_start(session->state.views), there;
    bool known = true;
    for (int i = 0; i <= position; i++) {
        bool brings = i < position && wr_history_restores_view(history, i);
        if ((brings || i == position) && wr_history_view(history, i, &there)) {
            if (!known || !wr_scene_view_equal(&now, &there)) put_view(&there, sink, ctx);
            now = there;
            known = true;
        }
        put_lines(wr_history_choices(history, i), sink, ctx);
        if (i == position) break;
        if (wr_history_is_off(history, i)) continue;
        sink(ctx, wr_history_line(history, i), wr_history_folder(history, i));
        known = known && !brings;
    }
}

#define STEPS(help_)                                                                               \
    {                                                                                              \
        .name = "N", .type = WR_ARG_NUMBER, .positional = true, .whole = true, .low = 1,           \
        .high = 1e9, .fallback = NUMBERS(1), .help = help_                                         \
    }

static const WrArgSpec args_undo[] = { STEPS("number of steps; left out, 1"), { 0 } };

static const WrArgSpec args_redo[] = { STEPS("number of steps; left out, 1"), { 0 } };

static const WrForm view_forms[] = {
    { .name = "back",
      .help = "number of views to go back",
      .args = { STEPS("number of views; left out, 1") } },
    { .name = "forward",
      .help = "number of views to go forward",
      .args = { STEPS("number of views; left out, 1") } },
};

WR_FORMS(form_view, view_forms)

static const WrArgSpec args_history[] = {
    { .name = "budget",
      .type = WR_ARG_NUMBER,
      .whole = true,
      .low = 0,
      .high = 1e15,
      .unit = "bytes",
      .help = "memory for old states; left out, unchanged (at first 1 GiB)" },
    { 0 }
};

static const WrArgSpec args_script[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "a script, *.wrinkle" },
    { .name = "steps",
      .type = WR_ARG_TEXT,
      .shape = "N|N,N..N",
      .check = wr_check_steps,
      .help = "steps to write, for `macro`; left out, all that are not undone" },
    { 0 }
};

/* ---- the rows ---- */

const WrCommand wr_command_script = {
    .name = "script",
    .kind = WR_CLASS_OUTPUT,
    .args = args_script,
    .run = run_script,
    .help = "write the history as a script",
    .details = "The script makes the same document, bit for bit. Undone steps are left out, and so "
               "are views that the steps do not need.",
    .example = "script bricks.wrinkle"
};

const WrCommand wr_command_undo = { .name = "undo",
                                    .kind = WR_CLASS_HISTORY,
                                    .args = args_undo,
                                    .run = run_undo,
                                    .steps = -1,
                                    .help = "undo the last commands",
                                    .details =
                                        "Every edit and every scene command is one step. The view "
                                        "does not change, except when the step opened a document.",
                                    .example = "undo 2" };

const WrCommand wr_command_redo = { .name = "redo",
                                    .kind = WR_CLASS_HISTORY,
                                    .args = args_redo,
                                    .run = run_redo,
                                    .steps = 1,
                                    .help = "redo the last undone commands",
                                    .example = "redo" };

const WrCommand wr_command_view = {
    .name = "view",
    .kind = WR_CLASS_HISTORY,
    .form_word = "WAY",
    .form = form_view,
    .run = run_view,
    .of_views = true,
    .help = "go back and forward through earlier views",
    .details = "Every `camera` and every `rotate` that changes something is one view; the last "
               "thousand are kept. Edits are not affected.",
    .example = "view back 2"
};

const WrCommand wr_command_history = {
    .name = "history",
    .kind = WR_CLASS_HISTORY,
    .args = args_history,
    .run = run_history,
    .help = "set the memory limit of undo",
    .details = "The oldest states are dropped first; the last step can always be undone.",
    .example = "history budget=2e9"
};
