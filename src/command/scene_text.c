/* The scene as the canonical lines that restore it from a new document. Every setting is printed, defaults too, so
   that a document keeps its meaning if a later version has other defaults. Only the default light, the surface's
   default pose and a missing picture have no line. */
#include "command/session_internal.h"

#include "base/text.h"
#include "command/commands.h"
#include "scene/objects.h"

typedef void Printer(const WrCommand *command, const WrScene *scene, WrText *text);

static void print_named(const WrCommand *command, const WrScene *scene, WrText *text)
{
    command->print(scene, text);
}

static void print_content(const WrCommand *command, const WrScene *scene, WrText *text)
{
    (command->print_content ? command->print_content : command->print)(scene, text);
}

/* Lines of one object; its rotation is printed with its position. */
static void print_own(const WrScene *scene, int object, Printer *printer, WrText *text)
{
    wr_print_object(scene, object, text);
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = wr_commands[i];
        if (command->of_object && !command->in_object)
            printer(command, wr_scene_object(scene, object), text);
    }
}

static void print_scene(const WrScene *scene, Printer *printer, WrScenePart *after, void *ctx,
                        WrText *text)
{
    const bool several = wr_scene_object_count(scene) > 1;
    for (int i = 0; several && i < wr_scene_object_count(scene); i++)
        print_own(scene, i, printer, text);
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = wr_commands[i];
        if (!command->print || (several && command->of_object)) continue;
        printer(command, scene, text);
        if (after) after(ctx, command, text);
    }
    wr_print_chosen(scene, text);
}

void wr_print_scene(const WrScene *scene, WrScenePart *after, void *ctx, WrText *text)
{
    print_scene(scene, print_named, after, ctx, text);
}

void wr_print_identity(const WrScene *scene, WrText *text)
{
    print_scene(scene, print_content, NULL, NULL, text);
}
