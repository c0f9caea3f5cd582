// What a cut hides is clipped. A browser cannot: it throws the pixels away.
#if defined(GL_ES) && defined(CUT)
in vec3 kept;
void cutAway() {
    if (min(min(kept.x, kept.y), kept.z) < 0.0) discard;
}
#else
void cutAway() {}
#endif
