use gudgeon_core::BuildError;
use gudgeon_core::geometry::FaceProfile;

/// Whether a face is one at all: positive length, finite drops.
pub(super) fn check_face(face: &FaceProfile) -> Result<(), BuildError> {
    let length = face.length();
    if !(length.is_finite() && length > 0.0) {
        return Err(BuildError::new(format!(
            "the length of a running face must be positive, not {length} m"
        )));
    }
    let finite = match face {
        FaceProfile::Parabola { curvature, apex, .. } => curvature.is_finite() && apex.is_finite(),
        FaceProfile::Taper { land, drop, .. } => *land > 0.0 && *land < length && drop.is_finite(),
        FaceProfile::Table { drops, .. } if drops.len() < 2 => {
            return Err(BuildError::new(format!(
                "a face profile needs two or more points, not {}",
                drops.len()
            )));
        }
        FaceProfile::Table { drops, .. } => drops.iter().all(|d| d.is_finite()),
    };
    if finite { Ok(()) } else { Err(BuildError::new("the drops of a running face must be finite")) }
}
