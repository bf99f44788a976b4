#include "ui/panels/missing_files.h"

#include "ui/app/jobs/files.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/panel_layers.h"

#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"

#include <stdlib.h>
#include <string.h>

static void forget(WrLayersState *state)
{
    for (int i = 0; i < WR_LAYERS_MAX; i++) {
        wr_free(state->missing[i]);
        state->missing[i] = NULL;
    }
}

static void look_up(WrApp *app)
{
    WrLayersState *state = app->layers;
    const WrDocument *document = wr_app_document(app);
    forget(state);
    for (int i = 0; i < document->layer_count; i++) {
        WrText path = { 0 };
        if (document->layers[i].line && wr_line_missing_file(document->layers[i].line, &path))
            state->missing[i] = wr_strdup(wr_text_get(&path));
        wr_text_fini(&path);
    }
    state->missing_of = document;
    state->missing_at = wr_session_revision(app->session);
}

const char *wr_missing_file(WrApp *app, int index)
{
    const WrLayersState *state = app->layers;
    if (state->missing_of != wr_app_document(app) ||
        state->missing_at != wr_session_revision(app->session))
        look_up(app);
    return app->layers->missing[index];
}

void wr_missing_file_locate(WrApp *app, int index)
{
    const char *path = wr_missing_file(app, index);
    if (!path) return;
    const char *slash = strrchr(path, '/');
    wr_free(app->layers->located);
    app->layers->located = wr_strdup(path);
    if (!wr_files_request_path(app->files, WR_FILE_LOCATE, NULL, slash ? slash + 1 : path))
        wr_dialog_open(app, WR_DIALOG_FILE);
}

void wr_missing_file_chosen(WrApp *app, const char *path)
{
    const WrDocument *document = wr_app_document(app);
    char *wanted = app->layers->located;
    app->layers->located = NULL;
    int done = 0;
    bool good = wanted != NULL;
    for (int i = 0; good && i < document->layer_count; i++) {
        WrText old = { 0 }, change = { 0 }, line = { 0 };
        const char *line_now = document->layers[i].line;
        const char *name = line_now ? wr_line_missing_file(line_now, &old) : NULL;
        if (name && strcmp(wr_text_get(&old), wanted) == 0) {
            if (*name) wr_text_addf(&change, "%s=", name);
            wr_text_add_word(&change, path);
            wr_text_addf(&line, "layer set %d", i + 1);
            wr_line_text(&line, "change", wr_text_get(&change));
            good = wr_app_run_line(app, wr_text_get(&line));
            done += good;
            document = wr_app_document(app);
        }
        wr_text_fini(&old);
        wr_text_fini(&change);
        wr_text_fini(&line);
    }
    if (good && done > 1) wr_app_say(app, "%d layers use the file again", done);
    wr_free(wanted);
}

void wr_missing_files_free(WrApp *app)
{
    forget(app->layers);
    wr_free(app->layers->located);
    app->layers->located = NULL;
}
