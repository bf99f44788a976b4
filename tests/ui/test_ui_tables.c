/* The registry of the window: every tool, action, dialog, tab, component and file purpose has its functions. */
#include "test.h"

#include "ui/app/registry_list.h"
#include "ui/app/state/action.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/registry.h"
#include "ui/canvas/tools/tool.h"
#include "ui/app/state/action_list.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/app/jobs/files.h"

#include "field/ops.h"

#include <string.h>

static const WrAction *action(const char *name)
{
    for (const WrAction *a = wr_registry.actions; a->name; a++)
        if (strcmp(a->name, name) == 0) return a;
    return NULL;
}

static void every_action_has_a_word_of_its_own_and_runs(void **state)
{
    (void)state;
    for (const WrAction *a = wr_registry.actions; a->name; a++) {
        if (action(a->name) != a) fail_msg("action %s stands twice", a->name);
        if (!a->label || !a->run) fail_msg("action %s lacks its label, or does nothing", a->name);
    }
}

/* Their texts are composed from other tables. */
static void actions_of_families_are_there(void **state)
{
    (void)state;
#define WORD(name, keys) #name,
    static const char *const names[] = { WR_FAMILY_ACTIONS(WORD) };
#undef WORD
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *rest = strchr(names[i], '_') + 1;
        bool adjusts = strncmp(names[i], "adjust_", 7) == 0;
        if (adjusts ? !wr_op_find(rest) : !wr_action_generator(names[i]))
            fail_msg("%s is none of its family", names[i]);
    }
}

static void every_tool_is_chosen_by_an_action(void **state)
{
    (void)state;
    for (int i = 0; i < wr_registry.tool_count; i++) {
        const WrTool *tool = wr_registry.tools[i];
        if (!tool) fail_msg("tool %d is none", i);
        if (!tool->action || !action(tool->action)) fail_msg("tool %d has no action", i);
        if (!tool->icon || !tool->help) fail_msg("tool %s lacks icon or help", tool->action);
    }
}

static void dialogs_tabs_parts_and_files_are_whole(void **state)
{
    (void)state;
    for (int i = 1; i < WR_DIALOG_COUNT; i++)
        if (!wr_registry.dialogs[i].draw) fail_msg("dialog %d shows nothing", i);
    for (int i = 0; i < WR_FILE_PURPOSES; i++)
        if (!wr_registry.takes[i]) fail_msg("nobody takes files of purpose %d", i);
    for (int i = 0; i < wr_registry.tab_count; i++) {
        const WrTab *tab = &wr_registry.tabs[i];
        if (!tab->label || !tab->draw == !tab->fill) fail_msg("tab %d: one of the two draws it", i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_action_has_a_word_of_its_own_and_runs),
        cmocka_unit_test(actions_of_families_are_there),
        cmocka_unit_test(every_tool_is_chosen_by_an_action),
        cmocka_unit_test(dialogs_tabs_parts_and_files_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
