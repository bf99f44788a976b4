/* The scene as the canonical lines that restore it from a new document. Every setting is written out,
   defaults too, so that a document means the same whatever the defaults of a later version are. Only
   the light of a new document, the surface's own pose and a missing picture have no line. */
#include "command/inner.h"

#include "base/text.h"
#include "scene/scene.h"

#include <string.h>

static void print_colour_content(const WrScene *scene, WrText *text)
{
    if (scene->colour && *scene->colour_sha256)
        wr_text_addf(text, "colour sha256=%s\n", scene->colour_sha256);
    else wr_print_colour(scene, text);
}

void wr_print_identity(const WrScene *scene, WrText *text)
{
    for (int i = 0; i < wr_command_count; i++) {
        if (strcmp(wr_commands[i]->name, "colour") == 0) print_colour_content(scene, text);
        else if (wr_commands[i]->print) wr_commands[i]->print(scene, text);
    }
}
