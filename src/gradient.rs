//! Derivatives of solved contacts: one linear solve for each output, whatever the number of parameters.
//!
//! On the cells C in contact, with B = (1, x, y), loaded freedoms f of motion λ and prescribed ones q of motion s, a
//! solution satisfies
//!
//! ```text
//! K p + h − B_f λ − B_q s_q = 0      −B_fᵀ p = −F/dA
//! ```
//!
//! While C stays, it is an analytic function of every parameter θ. With b = K̇ p + ḣ − B_q ṡ_q, where a dot is ∂/∂θ, and
//! A the symmetric matrix of the two equations,
//!
//! ```text
//! tangent    A (ṗ, λ̇) = (−b, −Ḟ/dA)                        one system for each parameter
//! adjoint    A (ψ, χ) = (∂J/∂p, ∂J/∂λ)                      one system for each output J
//!            dJ/dθ = ∂J/∂θ − ψᵀ b − χᵀ Ḟ/dA      dJ/dh = −ψ on C
//! ```
//!
//! These are the derivatives of the discrete contact, exact but for the tolerance of the linear solves: those that an
//! optimiser needs. They belong to a fixed number of cells in contact, so that they approach those of the continuum at
//! first order only, erratically, about 2e-4 of their size with 64 cells along the radius of a contact. The adjoint method
//! is textbook knowledge; its form for contacts with loaded degrees of freedom was derived here.
//!
//! A [`Linearisation`] holds what all outputs and parameters of one solution share. [`Solution::gradient`] makes one for a
//! single call.
//!
//! ```
//! use nacre::gradient::{Output, Parameter};
//! use nacre::{Elastic, Motion, Paraboloid, solve};
//!
//! let (ball, steel) = (Paraboloid::new(5e-3, 5e-3)?, Elastic::new(210e9, 0.3)?);
//! let solution = solve(&ball, &steel, &Motion::load(10.0))?;
//! let gradient = solution.gradient(&Output::Approach, Some(&ball))?;
//! // Hertz: δ ~ (W/E*)^{2/3} R^{−1/3}
//! let relative = |name: &str, value: f64| gradient.get(name).unwrap() * value / solution.approach;
//! assert!((relative("load", 10.0) - 2.0 / 3.0).abs() < 5e-3);
//! assert!((relative("body.substrate.young", 210e9) + 2.0 / 3.0).abs() < 5e-3);
//! assert!((relative("shape.radius_x", 5e-3) + relative("shape.radius_y", 5e-3) + 1.0 / 3.0).abs() < 5e-3);
//! # Ok::<(), nacre::Error>(())
//! ```
//!
//! [`Solution::gradient`]: crate::Solution::gradient

mod adjoint;
mod parameter;
mod seed;
mod state;
mod stress;

pub use adjoint::{LinearOptions, Linearisation};
pub use parameter::Parameter;
pub use seed::{Direction, Gradient, Measure, Output, StressOutput, StressPlace};
