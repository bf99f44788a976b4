/* The commands step and macro: earlier steps are changed, switched off, removed or moved, and those after them run again; and
   lines of a file run as one step.

   A change of step k runs again from the state before it, which the history holds. The new list shares the steps before k
   with the former one (wr_history_revise); a failed or cancelled change leaves the former list in force. The journal
   cannot replay such a line, since after a snapshot it has not the steps: it starts again after the change. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "scene/scene.h"
#include "system/path.h"

#include "base/enum_rows.h"

#include <stdlib.h>
#include <string.h>

/* ---- lists of steps ---- */

/* A number of a list, from 1. False: none is there. */
static bool number_at(const char **p, int *number)
{
    char *end;
    const long value = strtol(*p, &end, 10);
    *number = 0;
    if (**p < '0' || **p > '9' || value < 1 || value > 1000000000) return false;
    *number = (int)value;
    *p = end;
    return true;
}

bool wr_check_steps(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    int first, last;
    const char *p = value;
    char excerpt[WR_EXCERPT_SIZE];
    for (bool good = true; good; p++) {
        good = number_at(&p, &first);
        if (good && strncmp(p, "..", 2) == 0) {
            p += 2;
            good = number_at(&p, &last);
        }
        if (good && !*p) return true;
        if (good && *p != ',') break;
    }
    return wr_fail(err, "%s %s: must be numbers of steps, such as 3 or 2,4..6", name,
                   wr_excerpt(value, excerpt));
}

bool wr_step_listed(const char *list, int step)
{
    for (const char *p = list;; p++) {
        int first = 0, last;
        number_at(&p, &first);
        last = first;
        if (*p == '.') {
            p += 2;
            number_at(&p, &last);
        }
        if ((step >= first && step <= last) || (step >= last && step <= first)) return true;
        if (*p != ',') return false;
    }
}

/* ---- running again ---- */

typedef struct Line {
    char *line, *folder; /* owned; folder may be NULL */
    char *before,
        *choices; /* choices of layers before and after it, each with its line end; owned; `before` may be NULL */
    double seconds;
    bool off, changed;
} Line;

typedef struct Lines {
    Line *of; /* [count], owned */
    int first, count;
} Lines;

/* The steps in force from `first` on. */
static Lines lines_from(const WrSession *session, int first)
{
    const WrHistory *history = session->state.history;
    Lines lines = { .first = first, .count = wr_history_position(history) - first };
    lines.of = wr_alloc((size_t)lines.count + 1, sizeof *lines.of);
    for (int i = 0; i < lines.count; i++)
        lines.of[i] = (Line){ .line = wr_strdup(wr_history_line(history, first + i)),
                              .folder = wr_strdup(wr_history_folder(history, first + i)),
                              .choices = wr_strdup(wr_history_choices(history, first + i + 1)),
                              .seconds = wr_history_step_seconds(history, first + i),
                              .off = wr_history_is_off(history, first + i) };
    return lines;
}

static void free_line(Line *line)
{
    wr_free(line->line);
    wr_free(line->folder);
    wr_free(line->before);
    wr_free(line->choices);
}

static void lines_fini(Lines *lines)
{
    for (int i = 0; i < lines->count; i++) free_line(&lines->of[i]);
    wr_free(lines->of);
}

static bool run_choices(WrSession *session, const char *choices, WrError *err)
{
    for (const char *p = choices; *p; p += strcspn(p, "\n") + 1) {
        char *line = wr_strndup(p, strcspn(p, "\n"));
        const bool good = wr_session_run(session, line, err);
        wr_free(line);
        if (!good) return false;
    }
    return true;
}

/* A step that is off has its line, and the state before it. */
static bool run_again(WrSession *session, const Line *step, WrError *err)
{
    if (step->before && !run_choices(session, step->before, err)) return false;
    if (!step->off) {
        char *folder = session->folder;
        session->folder = step->folder;
        const bool good = wr_session_run(session, step->line, err);
        session->folder = folder;
        if (!good) return false;
    } else {
        wr_history_push(session->state.history, session->state.document, step->line, step->folder,
                        ++session->last_revision);
        wr_history_note_step(session->state.history, 0.0, true);
    }
    return run_choices(session, step->choices, err);
}

/* Lines that have not changed give no notes again. */
static bool run_all(WrSession *session, const Lines *lines, WrError *err)
{
    const WrNoteSink note = session->options.note;
    double total = 1e-9, done = 0.0;
    bool good = true;
    for (int i = 0; i < lines->count; i++) total += lines->of[i].off ? 0.0 : lines->of[i].seconds;
    for (int i = 0; i < lines->count && good; i++) {
        const Line *step = &lines->of[i];
        WrProgressPart part;
        const double end = done + (step->off ? 0.0 : step->seconds);
        const WrProgress *whole = wr_progress_enter(&part, done / total, end / total);
        session->options.note = step->changed ? note : NULL;
        good = run_again(session, step, err);
        wr_progress_set(whole);
        done = end;
        if (!good && !wr_progress_stopped())
            wr_error_prefix(err, "step %d cannot run after this change: ", lines->first + i + 1);
    }
    session->options.note = note;
    return good;
}

static void keep_view(WrSession *session, const WrSceneView *view)
{
    const WrSceneView now = wr_scene_view(session->state.document->scene);
    if (wr_scene_view_equal(&now, view)) return;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_set_pose(scene, view);
    wr_session_replace_scene(session, scene);
    wr_history_record_view(session->state.history, session->state.document);
}

/* Replace the steps from lines->first on. */
static bool revise(WrSession *session, const Lines *lines, WrError *err)
{
    const WrSceneView view = wr_scene_view(session->state.document->scene);
    const bool opening = session->opening;
    WrHistory *revision = wr_history_revise(session->state.history, lines->first);
    session->state.history = revision;
    session->opening = true; /* no journal, no composites in between */
    wr_session_restore(session);
    bool good = run_all(session, lines, err);
    session->opening = opening;
    if (good) keep_view(session, &view);
    good = good && wr_session_make_composite(session, err);
    if (good) wr_history_revised(revision);
    else session->state.history = wr_history_take_back(revision);
    if (!good) wr_session_restore(session);
    return good;
}

/* ---- the command step ---- */

static bool check_kept(const WrSession *session, int first, WrError *err)
{
    const int oldest = wr_session_history_oldest(session);
    if (first >= oldest) return true;
    return wr_fail(
        err,
        "step %d: the state before it was dropped to stay within the memory limit of the history; "
        "%d is the first that can be changed (`history budget=` raises the limit)",
        first + 1, oldest + 1);
}

static bool check_step(const WrSession *session, int step, WrError *err)
{
    const int position = wr_session_history_position(session);
    if (step < 0 || step >= wr_session_history_count(session))
        return wr_fail(err, "step %d: there are %d", step + 1, wr_session_history_count(session));
    if (step >= position)
        return wr_fail(err, "step %d is undone: redo it first, or go to it", step + 1);
    return check_kept(session, step, err);
}

static int step_of(const WrCall *call)
{
    return (int)wr_call_number(call, "N") - 1;
}

static bool step_go(WrSession *session, const WrCall *call, WrError *err)
{
    const int before = wr_session_history_position(session);
    if (!wr_session_go_to(session, step_of(call) + 1, err)) return false;
    if (wr_session_make_composite(session, err)) return true;
    wr_session_go_to(session, before, NULL);
    return false;
}

/* The line of a step with other values, or another line. The caller frees it. */
static char *changed_line(const char *line, const WrCall *call, WrError *err)
{
    WrCall *step = NULL;
    const char *change = wr_call_arg(call, "change")->text,
               *other = wr_call_arg(call, "line")->text;
    WrText text = { 0 };
    char *out = NULL;
    if (!change == !other) {
        wr_fail(err, "give line= or change=");
        return NULL;
    }
    bool good = wr_call_parse(other ? other : line, false, &step, err) &&
                (!change || wr_call_change(step, change, err));
    const WrCommandClass kind = good && step->command ? wr_call_class(step) : WR_CLASS_OUTPUT;
    if (good && kind != WR_CLASS_EDIT && kind != WR_CLASS_SCENE)
        good = wr_fail(err, "line=: must be an edit or a command of the scene");
    if (good) wr_call_print(step, &text);
    if (good) out = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    wr_call_free(step);
    return out;
}

static bool step_set(WrSession *session, const WrCall *call, WrError *err)
{
    const int step = step_of(call);
    if (!check_step(session, step, err)) return false;
    char *line = changed_line(wr_session_history_line(session, step), call, err);
    if (!line) return false;
    Lines lines = lines_from(session, step);
    bool good = true;
    if (strcmp(line, lines.of[0].line) != 0) {
        wr_free(lines.of[0].line);
        lines.of[0].line = line;
        lines.of[0].changed = true;
        if (wr_call_given(call, "line")) {
            wr_free(lines.of[0].folder);
            lines.of[0].folder = wr_strdup(session->folder);
        }
        good = revise(session, &lines, err);
    } else wr_free(line);
    lines_fini(&lines);
    return good;
}

/* The lowest listed step, after a check of all of them. -1: an error. list: NULL: none is given */
static int lowest_listed(const WrSession *session, const char *list, WrError *err)
{
    if (!list) {
        wr_fail(err, "must have numbers of steps, such as 3 or 2,4..6");
        return -1;
    }
    const int position = wr_session_history_position(session);
    int lowest = -1, highest = 0;
    for (const char *p = list; *p; p += strspn(p, ",.")) {
        int number = 0;
        number_at(&p, &number);
        if (lowest < 0 || number - 1 < lowest) lowest = number - 1;
        if (number - 1 > highest) highest = number - 1;
    }
    if (highest >= position) {
        check_step(session, highest, err);
        return -1;
    }
    return check_kept(session, lowest, err) ? lowest : -1;
}

static bool switch_steps(WrSession *session, const WrCall *call, bool off, WrError *err)
{
    const char *list = wr_call_arg(call, "N")->text;
    const int lowest = lowest_listed(session, list, err);
    if (lowest < 0) return false;
    Lines lines = lines_from(session, lowest);
    bool differs = false;
    for (int i = 0; i < lines.count; i++) {
        if (!wr_step_listed(list, lowest + i + 1) || lines.of[i].off == off) continue;
        lines.of[i].off = off;
        lines.of[i].changed = differs = true;
    }
    const bool good = !differs || revise(session, &lines, err);
    lines_fini(&lines);
    return good;
}

static bool step_off(WrSession *session, const WrCall *call, WrError *err)
{
    return switch_steps(session, call, true, err);
}

static bool step_on(WrSession *session, const WrCall *call, WrError *err)
{
    return switch_steps(session, call, false, err);
}

/* Take line i out. The choices of layers around it stay for the next lines. */
static Line take_out(Lines *lines, int i)
{
    Line line = lines->of[i];
    WrText text = { 0 };
    memmove(lines->of + i, lines->of + i + 1, (size_t)(lines->count - i - 1) * sizeof line);
    lines->count--;
    const bool last = i == lines->count;
    if (last && i == 0) return line;
    char **place = last ? &lines->of[i - 1].choices : &lines->of[i].before;
    wr_text_addf(&text, "%s%s%s%s", last ? *place : "", line.before ? line.before : "",
                 line.choices, !last && *place ? *place : "");
    wr_free(*place);
    *place = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return line;
}

static bool step_delete(WrSession *session, const WrCall *call, WrError *err)
{
    const char *list = wr_call_arg(call, "N")->text;
    const int lowest = lowest_listed(session, list, err);
    if (lowest < 0) return false;
    Lines lines = lines_from(session, lowest);
    for (int i = lines.count - 1; i >= 0; i--) {
        if (!wr_step_listed(list, lowest + i + 1)) continue;
        Line line = take_out(&lines, i);
        free_line(&line);
    }
    const bool good = revise(session, &lines, err);
    lines_fini(&lines);
    return good;
}

/* The only layer of that name; -1: there is none, or several. */
static int only_named(const WrDocument *document, const char *name)
{
    int found = -1;
    for (int i = 0; i < document->layer_count; i++)
        if (strcmp(document->layers[i].name, name) == 0) {
            if (found >= 0) return -1;
            found = i;
        }
    return found;
}

/* The line that chooses, in state `there`, the layer that was active in another state: the one of that name, else of that
   number. The caller frees it. NULL: there is none. */
static char *choice_of(const WrSession *session, int state, int there)
{
    const WrDocument *from = wr_history_document(session->state.history, state);
    const WrDocument *to = wr_history_document(session->state.history, there);
    const int named = only_named(to, from->layers[from->active].name);
    const int index = named >= 0 ? named : from->active;
    WrText line = { 0 };
    if (index >= to->layer_count) return NULL;
    const char *name = to->layers[index].name;
    wr_text_add(&line, "layer use ");
    if (named >= 0 && name[strspn(name, "0123456789")]) wr_text_add_word(&line, name);
    else wr_text_addf(&line, "%d", index + 1);
    wr_text_add(&line, "\n");
    char *out = wr_strdup(wr_text_get(&line));
    wr_text_fini(&line);
    return out;
}

/* The moved step applies to the layer that it applied to before, and so do the others. Steps commute if the document is the
   same afterwards; then only the list changes. */
static bool step_move(WrSession *session, const WrCall *call, WrError *err)
{
    const int from = step_of(call), to = (int)wr_call_number(call, "to") - 1;
    if (!check_step(session, from, err) || !check_step(session, to, err)) return false;
    if (from == to) return true;
    const WrHash before = wr_session_hash(session);
    const int first = from < to ? from : to, place = from < to ? to + 1 : to;
    char *own = choice_of(session, from, place), *others = choice_of(session, place, place);
    Lines lines = lines_from(session, first);
    Line moved = take_out(&lines, from - first), *at = lines.of + (to - first);
    memmove(at + 1, at, (size_t)(lines.count - (to - first)) * sizeof moved);
    lines.count++;
    wr_free(moved.choices);
    wr_free(moved.before);
    moved.before = own;
    moved.choices = own ? others : wr_strdup("");
    if (!own) wr_free(others);
    moved.changed = true;
    *at = moved;
    const bool good = revise(session, &lines, err);
    lines_fini(&lines);
    if (good && !wr_hash_equal(before, wr_session_hash(session)))
        wr_session_note(session, "the document changed: the order of these steps matters");
    return good;
}

enum { STEP_GO, STEP_SET, STEP_OFF, STEP_ON, STEP_DELETE, STEP_MOVE, STEP_FORMS };

static bool run_step(WrSession *session, WrCall *call, WrError *err)
{
    WR_ROWS(handlers);
    static bool (*const handlers[])(WrSession *, const WrCall *, WrError *) = {
        [WR_ROW(STEP_GO)] = step_go,         [WR_ROW(STEP_SET)] = step_set,
        [WR_ROW(STEP_OFF)] = step_off,       [WR_ROW(STEP_ON)] = step_on,
        [WR_ROW(STEP_DELETE)] = step_delete, [WR_ROW(STEP_MOVE)] = step_move,
    };
    WR_ROWS_END(handlers, STEP_FORMS);
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    return handlers[call->form](session, call, err);
}

/* ---- the command macro ---- */

#define MACRO_BYTES ((size_t)64 << 20)

/* The words for line `number` in values such as "2: size=40; 3: \"NEW WORDS\"". The caller frees them; NULL: none. */
static char *words_for(const char *values, int number)
{
    for (const char *p = values; *p;) {
        const int line = atoi(p);
        const char *from = p + strcspn(p, ":");
        bool quoted = false;
        for (p = from; *p && (quoted || *p != ';'); p++) {
            if (*p == '\\' && p[1]) p++;
            else if (*p == '"') quoted = !quoted;
        }
        if (line == number && *from) return wr_strndup(from + 1, (size_t)(p - from - 1));
        if (*p) p++;
    }
    return NULL;
}

static bool check_values(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    bool quoted = false, named = false;
    char excerpt[WR_EXCERPT_SIZE];
    for (const char *p = value; *p; p++) {
        if (*p == '\\' && p[1]) p++;
        else if (*p == '"') quoted = !quoted;
        else if (!quoted && *p == ':') named = true;
        else if (!quoted && *p == ';' && !named) break;
        else if (!quoted && *p == ';') named = false;
        else if (!named && !strchr(" 0123456789", *p)) break;
        if (!p[1] && named && !quoted) return true;
    }
    return wr_fail(err, "%s=%s: must be numbers of lines with values, such as \"2: size=40\"", name,
                   wr_excerpt(value, excerpt));
}

/* A line of the macro with its other values. The caller frees it; NULL: an error. */
static char *macro_line(const char *line, int number, const char *values, WrError *err)
{
    WrCall *call = NULL;
    WrText text = { 0 };
    char *words = words_for(values, number), *out = NULL;
    bool good = wr_call_parse(line, false, &call, err);
    if (good && call->command && wr_call_class(call) > WR_CLASS_CHOICE)
        good = wr_fail(err, "%s: a macro writes no files and has no `undo`", call->command->name);
    if (good && words && !call->command) good = wr_fail(err, "contains no command to change");
    good = good && (!words || wr_call_change(call, words, err));
    if (good) wr_call_print(call, &text);
    if (good) out = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    wr_call_free(call);
    wr_free(words);
    return out;
}

static bool run_macro_lines(WrSession *session, char *bytes, const char *path, const char *values,
                            WrError *err)
{
    int count = 1, number = 0;
    bool good = true;
    for (const char *p = bytes; *p; p++) count += *p == '\n';
    for (char *p = bytes; *p && good;) {
        const size_t length = strcspn(p, "\n");
        char *next = p + length + (p[length] == '\n');
        p[length] = '\0';
        if (length > 0 && p[length - 1] == '\r') p[length - 1] = '\0';
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, (double)number / count, (number + 1.0) / count);
        char *line = macro_line(p, ++number, values, err);
        good = line && wr_session_run(session, line, err);
        wr_free(line);
        wr_progress_set(whole);
        if (!good) wr_error_prefix(err, "%s:%d: ", path, number);
        p = next;
    }
    return good;
}

static bool run_macro(WrSession *session, WrCall *call, WrError *err)
{
    const char *name = wr_call_arg(call, "FILE")->text, *values = wr_call_arg(call, "values")->text;
    char *path = wr_session_input_path(session, name), *bytes = NULL, *folder = session->folder;
    size_t length;
    bool good = wr_session_check_sha256(call, path, err) &&
                wr_file_read(path, MACRO_BYTES, &bytes, &length, err);
    if (good && strlen(bytes) != length) {
        good = wr_fail(err, "contains a NUL byte: not a text file");
        wr_error_prefix(err, "%s: ", name);
    }
    if (good) {
        session->folder = wr_path_folder(path);
        good = run_macro_lines(session, bytes, name, values ? values : "", err);
        wr_free(session->folder);
        session->folder = folder;
    }
    wr_free(bytes);
    wr_free(path);
    return good;
}

/* ---- the rows ---- */

#define STEP(word, help_)                                                                          \
    {                                                                                              \
        .name = (word), .type = WR_ARG_NUMBER, .positional = true, .required = true,               \
        .whole = true, .low = 1, .high = 1e9, .help = help_                                        \
    }

#define STEPS                                                                                      \
    {                                                                                              \
        .name = "N", .positional = true, .type = WR_ARG_TEXT, .shape = "N|N,N..N",                 \
        .check = wr_check_steps, .help = "step numbers, counted from 1, the oldest"                \
    }

WR_ROWS(step_forms);
static const WrForm step_forms[] = {
    [WR_ROW(STEP_GO)] = { .name = "go",
                          .help = "go to the state after a step",
                          .args = { { .name = "N",
                                      .type = WR_ARG_NUMBER,
                                      .positional = true,
                                      .required = true,
                                      .whole = true,
                                      .low = 0,
                                      .high = 1e9,
                                      .help = "number of the step; 0: the beginning" } } },
    [WR_ROW(STEP_SET)] = { .name = "set",
                           .help = "change the command of a step",
                           .args = { STEP("N", "the step's number, from 1, the oldest"),
                                     { .name = "change",
                                       .type = WR_ARG_TEXT,
                                       .shape = "\"NAME=VALUE ...\"",
                                       .help = "arguments of its command to change" },
                                     { .name = "line",
                                       .type = WR_ARG_TEXT,
                                       .shape = "\"COMMAND ...\"",
                                       .help = "its new command" } } },
    [WR_ROW(STEP_OFF)] = { .name = "off",
                           .help = "switch steps off; they stay in the list",
                           .args = { STEPS } },
    [WR_ROW(STEP_ON)] = { .name = "on", .help = "switch steps on again", .args = { STEPS } },
    [WR_ROW(STEP_DELETE)] = { .name = "delete",
                              .help = "remove steps from the list",
                              .args = { STEPS } },
    [WR_ROW(STEP_MOVE)] = { .name = "move",
                            .help = "move a step earlier or later in the list",
                            .args = { STEP("N", "the step's number, from 1, the oldest"),
                                      { .name = "to",
                                        .type = WR_ARG_NUMBER,
                                        .required = true,
                                        .whole = true,
                                        .low = 1,
                                        .high = 1e9,
                                        .help = "its new number" } } },
};
WR_ROWS_END(step_forms, STEP_FORMS);

WR_FORMS(form_step, step_forms)

static const WrArgSpec args_macro[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "file of commands, *.wrinkle" },
    { .name = "values",
      .type = WR_ARG_TEXT,
      .shape = "\"N: NAME=VALUE ...; N: ...\"",
      .check = check_values,
      .help = "replacement arguments for its lines, counted from 1" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the file; left out, any content" },
    { 0 }
};

const WrCommand wr_command_step = {
    .name = "step",
    .kind = WR_CLASS_HISTORY,
    .form_word = "ACTION",
    .form = form_step,
    .run = run_step,
    .after_journal = true,
    .help = "change earlier steps of the history",
    .details = "All steps after a changed one run again; one `undo` reverts the change. If one of "
               "them fails, nothing changes and the error names it. Steps that are off are left "
               "out of scripts.",
    .example = "step set 1 change=\"width=512\""
};

const WrCommand wr_command_macro = {
    .name = "macro",
    .kind = WR_CLASS_EDIT,
    .args = args_macro,
    .run = run_macro,
    .help = "run the commands of a file as one step",
    .details = "`script FILE steps=2,4..6` writes such a file. Lines that write files or move "
               "through the history are refused.",
    .example = "macro frame.wrinkle values=\"2: radius=12\""
};
