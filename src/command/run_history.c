/* undo, redo, history, script: what was done. */
#include "command/inner.h"

#include "base/file.h"
#include "base/memory.h"

#include <string.h>

bool wr_run_undo(WrSession *session, WrCall *call, WrError *err)
{
    int steps = (int)wr_call_number(call, "N");
    int position = wr_session_history_position(session);
    int most = position - wr_session_history_oldest(session);
    if (position == 0) return wr_fail(err, "nothing to undo");
    if (steps > most)
        return wr_fail(err, "%d steps: %d can be undone%s", steps, most,
                       position > most ? "; older states were given up to keep the history in its "
                                         "budget"
                                       : "");
    return wr_session_go_to(session, position - steps, err);
}

bool wr_run_redo(WrSession *session, WrCall *call, WrError *err)
{
    int steps = (int)wr_call_number(call, "N");
    int position = wr_session_history_position(session);
    int most = wr_session_history_count(session) - position;
    if (most == 0) return wr_fail(err, "nothing to redo");
    if (steps > most) return wr_fail(err, "%d steps: %d can be redone", steps, most);
    return wr_session_go_to(session, position + steps, err);
}

bool wr_run_history(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    if (wr_call_given(call, "budget"))
        wr_session_set_history_budget(session, (size_t)wr_call_number(call, "budget"));
    int position = wr_session_history_position(session);
    wr_session_note(session, "%d steps can be undone, %d redone; they take %.1f of %.1f MB",
                    position - wr_session_history_oldest(session),
                    wr_session_history_count(session) - position,
                    (double)wr_session_history_bytes(session) / 1e6,
                    (double)wr_session_history_budget(session) / 1e6);
    return true;
}

/* ---- as a script ---- */

/* `path` as a script in `home` (absolute, "" if unknown) names it. Points into path. */
static const char *seen_from(const char *home, const char *path)
{
    size_t length = strlen(home);
    bool below = length > 0 && strncmp(path, home, length) == 0 && path[length] == '/';
    return below ? path + length + 1 : path;
}

typedef struct Script {
    WrText text;
    const char *home; /* its folder */
} Script;

/* Files that were read carry a hash: name them so that the script finds them. */
static void add_line(void *ctx, const char *line, const char *folder)
{
    Script *script = ctx;
    WrText *text = &script->text;
    WrCall *call = NULL;
    if (!wr_call_parse(line, false, &call, NULL)) { /* cannot be: it ran */
        wr_text_addf(text, "%s\n", line);
        return;
    }
    for (int i = 0; i < call->count; i++) {
        const char *hash = wr_call_hash_name(call, i);
        if (!hash || !wr_call_given(call, hash) || !wr_call_names_file(call, i)) continue;
        char *full = wr_path_join(folder ? folder : ".", call->args[i].text);
        wr_call_set_text(call, call->specs[i].name, seen_from(script->home, full));
        wr_free(full);
    }
    wr_call_print(call, text);
    wr_text_add(text, "\n");
    wr_call_free(call);
}

bool wr_session_save_history(WrSession *session, const char *path, WrError *err)
{
    char *folder = wr_path_folder(path), *real = realpath(folder, NULL);
    Script script = { .home = real ? real : "" };
    if (session->state.origin) add_line(&script, session->state.origin, NULL);
    wr_session_lines(session, add_line, &script);
    bool good = wr_file_write(path, wr_text_get(&script.text), script.text.length, err);
    free(real);
    wr_free(folder);
    wr_text_fini(&script.text);
    return good;
}

bool wr_run_script(WrSession *session, WrCall *call, WrError *err)
{
    return wr_session_save_history(session, wr_call_arg(call, "FILE")->text, err);
}
