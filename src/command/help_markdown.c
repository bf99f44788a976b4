#include "command/help.h"

#include "base/error.h"
#include "base/text.h"

void wr_help_markdown_cell(WrText *text, const char *words)
{
    for (const char *p = words; *p; p++)
        if (*p == '|' || *p == '*' || *p == '<') wr_text_addf(text, "\\%c", *p);
        else wr_text_add_n(text, p, 1);
}

/* Print the meanings of the choice words. */
static void add_meanings(WrText *text, const WrArgSpec *spec)
{
    for (int i = 0; spec->explain && wr_arg_word(spec, i); i++) {
        WrText meaning = { 0 };
        spec->explain(i, &meaning);
        wr_text_addf(text, "%s `%s` ", i ? ";" : ":", wr_arg_word(spec, i));
        wr_help_markdown_cell(text, wr_text_get(&meaning));
        wr_text_fini(&meaning);
    }
}

static void add_argument(WrText *text, const WrCommand *command, int form, const WrArgSpec *spec)
{
    WrText words = { 0 };
    wr_text_add(text, "| `");
    wr_help_argument_name(spec, text);
    wr_text_add(text, spec->required ? "` | required: " : "` | ");
    wr_help_argument(command, form, spec, &words);
    wr_help_markdown_cell(text, wr_text_get(&words));
    add_meanings(text, spec);
    wr_text_add(text, " |\n");
    wr_text_fini(&words);
}

/* head: title of the first column. Without arguments nothing is printed. */
static void add_arguments(WrText *text, const WrCommand *command, int form, const char *head,
                          const WrArgSpec *specs, int count)
{
    if (count == 0) return;
    wr_text_addf(text, "\n| %s | |\n| --- | --- |\n", head);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < count; i++)
            if (specs[i].positional == (pass == 0)) add_argument(text, command, form, &specs[i]);
}

static void add_form(WrText *text, const WrCommand *command, int form)
{
    WrArgSpec specs[WR_ARGS_MAX];
    WrForm row;
    int count = wr_command_specs(command, form, specs);
    if (form >= 0 && command->form(form, &row)) {
        count = wr_help_own(command, count);
        wr_text_addf(text, "\n### %s %s\n\n", command->name, row.name);
        wr_help_markdown_cell(text, row.help);
        wr_text_add(text, ".\n");
    }
    add_arguments(text, command, form, "argument", specs, count);
}

static void add_common(WrText *text, const WrCommand *command)
{
    int count = 0;
    while (command->more[count].name) count++;
    add_arguments(text, command, -1, "all of them also take", command->more, count);
}

bool wr_help_markdown(const char *name, WrText *text, WrError *err)
{
    WrText plain = { 0 };
    const WrCommand *command = wr_command_find(name);
    bool known = wr_help_command(name, &plain, err); /* the error suggests similar names */
    wr_text_fini(&plain);
    if (!known) return false;
    wr_text_addf(text, "## %s\n\n", command->name);
    wr_help_markdown_cell(text, command->help);
    wr_text_addf(text, " (%s). For example\n\n    %s\n", wr_class_names[command->kind],
                 command->example);
    if (command->details) wr_text_add(text, "\n");
    if (command->details) wr_help_markdown_cell(text, command->details);
    if (command->details) wr_text_add(text, "\n");
    WrForm row;
    if (!command->form) add_form(text, command, -1);
    for (int i = 0; command->form && command->form(i, &row); i++) add_form(text, command, i);
    if (command->form && command->more) add_common(text, command);
    return true;
}

void wr_help_markdown_verbs(WrText *text)
{
    wr_text_add(text, "| verb | class | |\n| --- | --- | --- |\n");
    for (int i = 0; i < wr_command_count; i++) {
        wr_text_addf(text, "| `%s` | %s | ", wr_commands[i]->name,
                     wr_class_names[wr_commands[i]->kind]);
        wr_help_markdown_cell(text, wr_commands[i]->help);
        wr_text_add(text, " |\n");
    }
}
