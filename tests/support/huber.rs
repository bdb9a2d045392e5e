//! Stress below Hertzian contacts in closed form.

/// Stresses xx, yy, zz, xy, yz, xz below Hertz's pressure on the unit disc; Huber (1904), after Hills, Nowell
/// & Sackfield, Mechanics of Elastic Contacts (1993).
pub(crate) fn huber(nu: f64, x: f64, y: f64, z: f64) -> [f64; 6] {
    let r2 = x * x + y * y;
    let s = r2 + z * z - 1.0;
    let u = 0.5 * (s + (s * s + 4.0 * z * z).sqrt());
    let root = u.sqrt();
    let cubed = (z / root).powi(3);
    let deep = u / (u * u + z * z);
    let angle = (1.0 / root).atan();
    let zz = -cubed * deep;
    if r2 < 1e-18 {
        let lateral = -(1.0 + nu) * (1.0 - z * (1.0 / z).atan()) + 0.5 / (1.0 + z * z);
        return [lateral, lateral, zz, 0.0, 0.0, 0.0];
    }
    let spread = (1.0 - 2.0 * nu) / (3.0 * r2) * (1.0 - cubed);
    let stretch = u * (1.0 - nu) / (1.0 + u);
    let radial = spread + cubed * deep + z / root * (stretch + (1.0 + nu) * root * angle - 2.0);
    let hoop = -(spread + z / root * (2.0 * nu + stretch - (1.0 + nu) * root * angle));
    let shear = -z * z / (u * u + z * z) * root / (1.0 + u);
    let (c2, s2, cs) = (x * x / r2, y * y / r2, x * y / r2);
    [
        radial * c2 + hoop * s2,
        radial * s2 + hoop * c2,
        zz,
        (radial - hoop) * cs,
        shear * y,
        shear * x,
    ]
}
