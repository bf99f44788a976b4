#include "ui/app/state/workspace.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"

#include "base/enum_rows.h"
#include "base/memory.h"
#include "base/text.h"

#include <stdio.h>
#include <string.h>

WR_ROWS(wr_workspaces);
const WrWorkspace wr_workspaces[WR_WORKSPACES] = {
    [WR_ROW(WR_WORKSPACE_PAINT)] = { "paint", "Paint", "Brushes", "" },
    [WR_ROW(WR_WORKSPACE_GENERATE)] = { "generate", "Generate", "Generate", "lower 0.35" },
    [WR_ROW(WR_WORKSPACE_LIGHT)] = { "light", "Lighting", "Scene",
                                     "divider 0.3\tlower 0\thide_options 1\tfold -Scene/OBJECTS\t"
                                     "fold -Scene/SURFACE\tfold -Scene/BUMP\tfold "
                                     "-Scene/MATERIAL\tfold +Scene/CAMERA\t"
                                     "fold +Scene/BACKGROUND\tfold +Scene/EXPOSURE" },
    [WR_ROW(WR_WORKSPACE_EXPORT)] = { "export", "Export", "Export",
                                      "lower 0.35\thide_strip 1\thide_options 1" },
    [WR_ROW(WR_WORKSPACE_STUDY)] = { "study", "Study", "Accuracy",
                                     "inspector 1\tmeters 1\thide_options 1\tside_width 340" },
};
WR_ROWS_END(wr_workspaces, WR_WORKSPACES);

const char *wr_workspace_action(WrWorkspaceKind kind, char buffer[48])
{
    snprintf(buffer, 48, "workspace_%s", wr_workspaces[kind].name);
    return buffer;
}

/* The entry "NAME PLACE" of a workspace in the list of changed ones; without one, the place of a new entry. */
static int entry_of(char *const *list, const char *name)
{
    const size_t length = strlen(name);
    int i = 0;
    while (i < WR_WORKSPACES_MAX - 1 && list[i] &&
           !(strncmp(list[i], name, length) == 0 && list[i][length] == ' '))
        i++;
    return i;
}

static void store(WrSettings *settings)
{
    const char *name = wr_workspaces[settings->workspace].name;
    char **entry = &settings->workspaces[entry_of(settings->workspaces, name)];
    WrText text = { 0 };
    wr_text_addf(&text, "%s ", name);
    wr_settings_place_print(settings, &text);
    wr_settings_set_text(entry, wr_text_get(&text));
    wr_text_fini(&text);
}

void wr_workspace_reset(WrApp *app)
{
    WrSettings *settings = app->settings;
    const WrWorkspace *row = &wr_workspaces[settings->workspace];
    WrSettings plain = wr_settings_default();
    WrText text = { 0 };
    wr_settings_place_print(&plain, &text);
    wr_text_add(&text, row->place);
    wr_settings_place_parse(settings, wr_text_get(&text));
    settings->tab = wr_tab_find(app, row->tab);
    wr_app_redraw(app);
    wr_text_fini(&text);
}

void wr_workspace_choose(WrApp *app, WrWorkspaceKind kind)
{
    WrSettings *settings = app->settings;
    store(settings);
    settings->workspace = (int)kind;
    settings->panels = true;
    const char *name = wr_workspaces[kind].name,
               *entry = settings->workspaces[entry_of(settings->workspaces, name)];
    if (entry) wr_settings_place_parse(settings, entry + strlen(name) + 1);
    else wr_workspace_reset(app);
    wr_app_redraw(app);
}
