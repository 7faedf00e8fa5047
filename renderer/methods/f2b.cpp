// Front-to-back blending: F2B of Vlcek, Havel, Herout, SCCG 2010, section 2, equations (3) to (5).
// The transparent primitives are drawn from near to far into an RGBA texture that starts at (0, 0, 0, 1), with
// premultiplied color and inverted alpha; the texture is then laid over the opaque picture.
#include "renderer/methods/shared/front_to_back.h"

namespace sheer {

MethodInfo method_f2b() {
    return describe_method(
        {
            .id = "f2b",
            .name = "F2B",
            .kind = "sorted blending",
            .summary =
                "Premultiplied blending from near to far into a texture, laid over the opaque picture at the end.",
            .paper =
                "Vlcek, Havel, Herout, Front-to-Back Blending with Early Fragment Discarding, SCCG 2010, section 2",
            .good_at = "The same picture as B2F; cheaper blend factors; the base of every early-discard method.",
            .bad_at = "One more texture, a clear and a full-screen pass, which do not pay below about 16 quads.",
            .memory = "one pixel of the image format",
            .passes = "1, and a full-screen one",
        },
        AlphaForm::table(), make_new<FrontToBack>, pixels_and_bytes(1));
}

}  // namespace sheer
