#include "ui/help/guide_run.h"
#include "ui/state/app_state.h"
#include "ui/toolkit/words.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

bool wr_guide_is_command(const char *line)
{
    WrCall *call = NULL;
    WrError err;
    const bool good = wr_call_parse(line, false, &call, &err) && call->command;
    wr_call_free(call);
    return good;
}

/* Absolute path of the file that an output command writes; NULL if it names none. Caller frees. */
static char *written_file(const WrCall *call)
{
    for (int i = 0; i < call->count; i++) {
        if (call->specs[i].type != WR_ARG_PATH || !call->args[i].given) continue;
        char *folder = wr_path_here();
        char *path = wr_path_join(folder ? folder : "", call->args[i].text);
        free(folder);
        return path;
    }
    return NULL;
}

static void add_output(const WrCall *call, WrText *out)
{
    char *path = written_file(call);
    if (!path) wr_text_add(out, wr_words("Writes files."));
    else if (wr_path_is_there(path))
        wr_text_addf(out, wr_words("Replaces the file %s. Undo does not bring it back."), path);
    else wr_text_addf(out, wr_words("Writes the file %s."), path);
    wr_free(path);
}

void wr_guide_effect(const WrApp *app, const char *line, WrText *out)
{
    const WrDocument *document = wr_session_document(app->session);
    WrCall *call = NULL;
    WrError err;
    if (!wr_call_parse(line, false, &call, &err) || !call->command) {
        wr_call_free(call);
        return;
    }
    switch (wr_call_class(call)) {
    case WR_CLASS_EDIT:
        wr_text_addf(out,
                     wr_words("Changes layers, heights or the selection; the active layer is %s. "
                              "One undo step."),
                     document->layers[document->active].name);
        break;
    case WR_CLASS_SCENE:
        wr_text_add(out, wr_words("Changes the scene and no heights. One undo step."));
        break;
    case WR_CLASS_VIEW:
        wr_text_add(out, wr_words("Changes the view, no heights. No undo step."));
        break;
    case WR_CLASS_OUTPUT: add_output(call, out); break;
    default: wr_text_add(out, wr_words("Goes to another step of the history.")); break;
    }
    wr_call_free(call);
}
