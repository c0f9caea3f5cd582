#include "render_client/look/paint/film_painter.h"

#include <string>

#include "render_client/look/model/material_palette.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr GLenum kUnit = 1;  // of the texture; 0 is the shadow's

}  // namespace

FilmPainter::FilmPainter(const GlApi& gl, bool has_materials) : gl_(gl), texture_(gl) {
    setMaterials(has_materials);
    constexpr int kCells = SurfaceFilm::kCells;
    gl_.ActiveTexture(GL_TEXTURE0 + kUnit);
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.TexImage3D(GL_TEXTURE_3D, 0, GL_RG8, kCells, kCells, kCells, 0, GL_RG, GL_UNSIGNED_BYTE, nullptr);
    for (const GLenum direction : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        gl_.TexParameteri(GL_TEXTURE_3D, direction, GL_REPEAT);
    gl_.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl_.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.check("making the film's texture");
}

void FilmPainter::setMaterials(bool has_materials) {
    const std::string define = has_materials ? MaterialPalette::kDefine : "";
    surface_ = std::make_unique<Program>(gl_, "bone with a film", define + shaders::kMeshVertex,
                                         define + "#define FILM\n" + shaders::kBoneFragment);
}

Eigen::AlignedBox3f FilmPainter::update(const EffectPicture& picture) {
    SurfaceFilm& film = *picture.film;
    const Eigen::Vector2f strength(picture.shows_blood, picture.shows_water);
    if (!film.takeDue() && strength == strength_) return {};
    Eigen::AlignedBox3f changed = film.takeChanged();
    if (strength != strength_) changed.extend(film.shownBox());
    strength_ = strength;
    blood_colour_ = picture.blood_colour;
    period_ = film.extent();
    shown_ = film.shownBox();
    const auto slices = film.takeChangedSlices();
    if (slices.none()) return changed;
    constexpr int kCells = SurfaceFilm::kCells;
    gl_.ActiveTexture(GL_TEXTURE0 + kUnit);
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int z = 0; z < kCells; ++z)
        if (slices[size_t(z)])
            gl_.TexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, z, kCells, kCells, 1, GL_RG, GL_UNSIGNED_BYTE,
                              film.slice(z).data());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.ActiveTexture(GL_TEXTURE0);
    return changed;
}

void FilmPainter::setUniforms() const {
    gl_.ActiveTexture(GL_TEXTURE0 + kUnit);
    gl_.BindTexture(GL_TEXTURE_3D, texture_.name());
    gl_.ActiveTexture(GL_TEXTURE0);
    surface_->set("film", int(kUnit));
    surface_->set("film_period", period_);
    const bool is_anywhere = !shown_.isEmpty();
    surface_->set("film_low", is_anywhere ? shown_.min() : Eigen::Vector3f::Ones().eval());
    surface_->set("film_high", is_anywhere ? shown_.max() : Eigen::Vector3f::Zero().eval());
    surface_->set("film_strength", strength_);
    surface_->set("blood_colour", blood_colour_);
}

}  // namespace bonemill
