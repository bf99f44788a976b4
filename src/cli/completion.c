/* Completion scripts for bash, zsh and fish, from the tables of subcommands, options and commands. */
#include "base/error.h"
#include "base/text.h"
#include "cli/cli.h"
#include "command/command_table.h"
#include "export/export.h"
#include "export/map_sets.h"

#include <string.h>

/* Each writer prints one script. Values of options that are words of a table are completed from it; all other values and words
   are file names. */

/* ---- words ---- */

static void add_kinds(WrText *text)
{
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        wr_text_addf(text, "%s%s", i ? " " : "", wr_export_kinds[i].name);
    for (int i = 0; i < WR_MAP_SET_ROWS; i++) wr_text_addf(text, " %s", wr_map_set_rows[i].name);
}

static void add_isas(WrText *text)
{
    wr_text_add(text, "auto ref v1 v2 v3 v4");
}

static void add_shells(WrText *text)
{
    wr_text_add(text, "bash zsh fish");
}

static void add_verbs(WrText *text)
{
    for (int i = 0; i < wr_command_count; i++)
        wr_text_addf(text, "%s%s", i ? " " : "", wr_commands[i]->name);
}

/* Options whose values are words. */
static const struct {
    const char *option, *subcommand; /* subcommand NULL: any */
    void (*add)(WrText *text);
} values[] = { { "--as", "export", add_kinds },
               { "--isa", NULL, add_isas },
               { "--completion", "help", add_shells } };
#define VALUES (sizeof values / sizeof *values)

/* Adds text that stands between single quotes of a shell. */
static void add_quoted(WrText *text, const char *words, const char *escaped)
{
    for (const char *p = words; *p; p++) {
        if (*p == '\'') wr_text_add(text, "'\\''");
        else if (strchr(escaped, *p)) wr_text_addf(text, "\\%c", *p);
        else wr_text_add_n(text, p, 1);
    }
}

/* Calls add for each option of a subcommand and for the common ones. */
static void each_option(const WrSubcommand *command, WrText *text,
                        void (*add)(const WrSubcommand *command, const char *const o[4],
                                    WrText *text))
{
    const char *o[4];
    for (int common = 0; common < 2; common++)
        for (int i = 0; wr_cli_option(common ? &wr_subcommands[0] : command, common, i, o); i++)
            add(command, o, text);
}

/* ---- bash ---- */

static void add_bash_option(const WrSubcommand *command, const char *const o[4], WrText *text)
{
    (void)command;
    wr_text_addf(text, " %s%s%s", o[0], o[1] ? " " : "", o[1] ? o[1] : "");
}

static void print_bash(WrText *text)
{
    wr_text_add(text,
                "# Completion of wrinkle for bash.\n"
                "_wrinkle() {\n"
                "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
                "    local subcommand= word words=\n"
                "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
                "        [[ $word == -* ]] || { subcommand=$word; break; }\n"
                "    done\n"
                "    case $subcommand:$previous in\n");
    for (size_t i = 0; i < VALUES; i++) {
        wr_text_addf(text, "    %s:%s) words='", values[i].subcommand ? values[i].subcommand : "*",
                     values[i].option);
        values[i].add(text);
        wr_text_add(text, "' ;;\n");
    }
    wr_text_add(text, "    *)\n        case $subcommand in\n");
    for (const WrSubcommand *c = wr_subcommands; c->name; c++) {
        wr_text_addf(text, "        %s) words='", c->name);
        each_option(c, text, add_bash_option);
        wr_text_add(text, "' ;;\n");
    }
    wr_text_add(text, "        esac\n"
                      "        [[ $current == -* ]] || words=\n"
                      "        [[ $subcommand != help || $current == -* ]] || words='");
    add_verbs(text);
    wr_text_add(text, "'\n        [[ -n $subcommand ]] || words='");
    for (const WrSubcommand *c = wr_subcommands; c->name; c++) wr_text_addf(text, "%s ", c->name);
    wr_text_add(
        text,
        "--help --version'\n        ;;\n    esac\n"
        "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
        "    [[ $current == -* || $subcommand:$previous == *:--as || $previous == --isa ]] ||\n"
        "        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- \"$current\")\n"
        "}\n"
        "complete -o filenames -F _wrinkle wrinkle\n");
}

/* ---- zsh ---- */

static void add_zsh_option(const WrSubcommand *command, const char *const o[4], WrText *text)
{
    for (int k = 0; k < 2 && o[k]; k++) {
        wr_text_addf(text, " \\\n            '*%s[", o[k]);
        add_quoted(text, o[3], "[]:");
        wr_text_add(text, "]");
        if (o[2]) wr_text_addf(text, ":%s:", o[2]);
        size_t i = 0;
        while (i < VALUES &&
               (strcmp(values[i].option, o[k]) != 0 ||
                (values[i].subcommand && strcmp(values[i].subcommand, command->name) != 0)))
            i++;
        if (o[2] && i < VALUES) {
            wr_text_add(text, "(");
            values[i].add(text);
            wr_text_add(text, ")");
        } else if (o[2]) {
            wr_text_add(text, "_files");
        }
        wr_text_add(text, "'");
    }
}

static void print_zsh(WrText *text)
{
    wr_text_add(text, "#compdef wrinkle\n"
                      "_wrinkle() {\n"
                      "    local -a subcommands=(\n");
    for (const WrSubcommand *c = wr_subcommands; c->name; c++) {
        wr_text_addf(text, "        '%s:", c->name);
        add_quoted(text, c->help, ":");
        wr_text_add(text, "'\n");
    }
    wr_text_add(text, "    )\n"
                      "    if (( CURRENT == 2 )); then\n"
                      "        _describe subcommand subcommands\n"
                      "        _files\n"
                      "        return\n"
                      "    fi\n"
                      "    case $words[2] in\n");
    for (const WrSubcommand *c = wr_subcommands; c->name; c++) {
        wr_text_addf(text, "    %s)\n        _arguments", c->name);
        each_option(c, text, add_zsh_option);
        if (strcmp(c->name, "help") == 0) {
            wr_text_add(text, " \\\n            '*:command:(");
            add_verbs(text);
            wr_text_add(text, ")'\n        ;;\n");
        } else {
            wr_text_add(text, " \\\n            '*:file:_files'\n        ;;\n");
        }
    }
    wr_text_add(text, "    *) _files ;;\n    esac\n}\n_wrinkle \"$@\"\n");
}

/* ---- fish ---- */

static void add_fish_option(const WrSubcommand *command, const char *const o[4], WrText *text)
{
    wr_text_addf(text, "complete -c wrinkle -n '__fish_seen_subcommand_from %s'", command->name);
    for (int k = 0; k < 2 && o[k]; k++)
        wr_text_addf(text, o[k][1] == '-' ? " -l %s" : " -s %s", o[k] + strspn(o[k], "-"));
    for (size_t i = 0; i < VALUES; i++)
        if (strcmp(values[i].option, o[0]) == 0 &&
            (!values[i].subcommand || strcmp(values[i].subcommand, command->name) == 0)) {
            wr_text_add(text, " -x -a '");
            values[i].add(text);
            wr_text_add(text, "'");
        }
    wr_text_addf(text, "%s -d '", o[2] ? " -r" : "");
    add_quoted(text, o[3], "");
    wr_text_add(text, "'\n");
}

static void print_fish(WrText *text)
{
    wr_text_add(text, "# Completion of wrinkle for fish.\n");
    for (const WrSubcommand *c = wr_subcommands; c->name; c++) {
        wr_text_addf(text, "complete -c wrinkle -n __fish_use_subcommand -a %s -d '", c->name);
        add_quoted(text, c->help, "");
        wr_text_add(text, "'\n");
        each_option(c, text, add_fish_option);
    }
    wr_text_add(text, "complete -c wrinkle -n '__fish_seen_subcommand_from help' -f -a '");
    add_verbs(text);
    wr_text_add(text, "'\n");
}

static const struct {
    const char *name;
    void (*print)(WrText *text);
} shells[] = { { "bash", print_bash }, { "zsh", print_zsh }, { "fish", print_fish } };

static const char *shell_name(const void *ctx, int i)
{
    (void)ctx;
    return i < (int)(sizeof shells / sizeof *shells) ? shells[i].name : NULL;
}

int wr_cli_print_completion(const WrCli *cli)
{
    WrError err;
    WrText text = { 0 };
    int i;
    if (!wr_cli_find_word("--completion", cli->completion, shell_name, NULL, &i, &err))
        return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    shells[i].print(&text);
    const int status = wr_cli_print(cli, &text);
    wr_text_fini(&text);
    return status;
}
