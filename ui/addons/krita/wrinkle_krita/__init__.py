# SPDX-License-Identifier: MIT
"""Plugin of Krita: a layer as heights in Wrinkle. See ui/guide/krita-gimp.md."""
from krita import Krita

from .extension import WrinkleExtension

Krita.instance().addExtension(WrinkleExtension(Krita.instance()))
