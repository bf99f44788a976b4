/* fuzz_commands.c - untrusted command lines: for any bytes, a line is refused with a message or parsed to a call with
   a stable text; scene lines (the only ones allowed in a document file) run without harm. */
#include "base/error.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MUST(condition)                                                                            \
    do {                                                                                           \
        if (!(condition)) abort();                                                                 \
    } while (0)

/* print(parse(print(parse(x)))) equals print(parse(x)). */
static bool stable(const char *line, WrCall **out)
{
    WrError err = { "" };
    WrText first = { 0 }, second = { 0 };
    WrCall *again;
    if (!wr_call_parse(line, false, out, &err)) {
        MUST(err.text[0] != '\0');
        return false;
    }
    wr_call_print(*out, &first);
    MUST(wr_call_parse(wr_text_get(&first), false, &again, &err));
    wr_call_print(again, &second);
    MUST(strcmp(wr_text_get(&first), wr_text_get(&second)) == 0);
    wr_call_free(again);
    wr_text_fini(&first);
    wr_text_fini(&second);
    return true;
}

static bool reads_a_file(const WrCall *call)
{
    for (int i = 0; i < call->count; i++)
        if (call->specs[i].type == WR_ARG_PATH && call->args[i].given) return true;
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1), *rest = text;
    memcpy(text, data, size);
    text[size] = '\0';
    WrSession *session = wr_session_new(NULL);
    for (int lines = 0; rest && lines < 30; lines++) {
        char *line = strsep(&rest, "\n");
        WrCall *call = NULL;
        WrError err = { "" };
        if (!stable(line, &call)) continue;
        bool scene = call->command && call->command->print && !reads_a_file(call);
        wr_call_free(call);
        if (scene && !wr_session_run(session, line, &err)) MUST(err.text[0] != '\0');
    }
    WrText scene = { 0 };
    wr_session_scene_text(session, &scene); /* and their result can be printed again */
    wr_text_fini(&scene);
    wr_session_free(session);
    free(text);
    return 0;
}
