/* preset_help.h - brush presets from a short description. Include after test.h. */
#pragma once
#include "base/error.h"
#include "base/text.h"
#include "brush/preset.h"

static inline WrPreset *parse(const char *text, WrError *err)
{
    err->text[0] = '\0';
    return wr_preset_parse(text, strlen(text), "toy", NULL, err);
}

static inline WrPreset *with_relief(const char *relief, WrError *err)
{
    WrText text = { 0 };
    wr_text_addf(&text, "{\"version\": 3, \"settings\": {}, \"wrinkle\": %s}", relief);
    WrPreset *preset = parse(text.data, err);
    wr_text_fini(&text);
    return preset;
}
