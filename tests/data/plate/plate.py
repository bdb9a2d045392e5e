"""Exact surface displacement of a body with TWO free ends (strip 0<=x<=L, z>=0, wave cos(ky) along y),
pressure p(x) on z=0, faces x=0 and x=L free.  Reduction (BEARING.md 3.3):
  A: half-space under P continued evenly about x=0 and x=L (period 2L): no shear, u_x=0 on both faces
  B: infinite plate 0<=x<=L under pressure Q(|z|) on its faces: no shear and u_z=0 on z=0
  Q = T_A P (= sigma_xx of A on the face),  P = p + T_B Q (sigma_zz of B at z=0),   u = K_A P.
Classes sigma=+1/-1: P(L-x)=sigma P(x); then P(x+mL)=sigma^m P(x) and everything lives on 0<x<L/2.
Units: G=1; displacements are returned as  w = u*pi*G/(1-nu)  so that w_halfspace = int K0(k|x-x'|) p dx'.
"""
import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.special import kv, k0, k1

# ------------------------------------------------------------------ panel grids in t = ln x
class Panels:
    def __init__(self, breaks, n):
        b = np.log(np.asarray(breaks, float)); g, w = leggauss(n)
        self.b, self.n, self.g = b, n, g
        self.t = np.concatenate([0.5*(p+q)+0.5*(q-p)*g for p, q in zip(b[:-1], b[1:])])
        wt = np.concatenate([0.5*(q-p)*w for p, q in zip(b[:-1], b[1:])])
        self.x = np.exp(self.t); self.w = wt*self.x
        # barycentric weights of Gauss nodes
        self.bw = np.array([1/np.prod(g[i]-np.delete(g, i)) for i in range(n)])
    def interp(self, x):
        """sparse-as-dense matrix: values at nodes -> values at x (inside the range)"""
        t = np.log(np.asarray(x, float)); M = np.zeros((t.size, self.x.size))
        j = np.clip(np.searchsorted(self.b, t)-1, 0, len(self.b)-2)
        s = (t-0.5*(self.b[j]+self.b[j+1]))/(0.5*(self.b[j+1]-self.b[j]))
        d = s[:, None]-self.g; ex = np.abs(d) < 1e-15; d[ex] = 1
        c = self.bw/d; c[ex.any(1)] = ex[ex.any(1)]
        c /= c.sum(1, keepdims=True)
        M[np.arange(t.size)[:, None], j[:, None]*self.n+np.arange(self.n)] = c
        return M

def geo(lo, hi, ratio):
    n = int(np.ceil(np.log(hi/lo)/np.log(ratio)-1e-9)); return hi*np.exp(np.linspace(-np.log(hi/lo), 0, n+1))

# ------------------------------------------------------------------ single-end kernel
_g, _w = leggauss(12)
def J_outer(a, b, top):
    """J[i,j] = int_{b_i}^{top} K0(sqrt(a_j^2+t^2)) dt ; b ascending, k=1; positive sums only (no cancellation)"""
    e = np.append(b, max(top, b[-1]*1.0001)); out = np.zeros((len(b), len(a))); acc = np.zeros(len(a))
    for i in range(len(b)-1, -1, -1):
        lo, hi = e[i], e[i+1]; m = max(1, int(np.ceil(np.log(hi/lo)/1.2), ), int(np.ceil((hi-lo)/6)) if lo < 45 else 1)
        br = np.exp(np.linspace(np.log(lo), np.log(hi), m+1))
        for p, q in zip(br[:-1], br[1:]):
            s = 0.5*np.log(p*q)+0.5*np.log(q/p)*_g; t = np.exp(s)
            acc = acc + (0.5*np.log(q/p)*_w*t) @ k0(np.sqrt(a[None, :]**2+t[:, None]**2))
        out[i] = acc
    return out

def T1(z, x, k, nu):
    """T(z,x) on the outer grid: normal stress on the face at depth z from a unit pressure line at x AND its mirror -x"""
    a, b = k*np.asarray(x), k*np.asarray(z); R = np.sqrt(b[:, None]**2+a[None, :]**2)
    v = b[:, None]*a**2/R**2*(2*k1(R)/R+k0(R))
    if nu != 0.5: v = v-(1-2*nu)*J_outer(a, b, 60.0)
    return -(2/np.pi)*k*v

# ------------------------------------------------------------------ plate form
def TA(z, x, k, L, nu, sg):
    """sigma_xx on the face of the half-space under the class-sigma periodic source: sum of images of T1"""
    M = int(np.ceil(42/(k*L)))+1
    def part(xx, m0, m1):
        out = np.zeros((len(z), len(xx)))
        for m in range(m0, m1):
            out += sg**m*(T1(z, m*L+xx, k, nu)+sg*T1(z, (m+1)*L-xx, k, nu))
        return out
    x = np.asarray(x); out = part(x, 0, min(2, M))
    if M > 2:                                    # far images are smooth in x: 12 Chebyshev points on [0,L/2]
        n = 12; th = (np.arange(n)+.5)*np.pi/n; xc = L/4*(1+np.cos(th))
        F = part(xc, 2, M)
        V = np.cos(np.arange(n)[:, None]*th); c = 2/n*F @ V.T; c[:, 0] /= 2
        out += c @ np.cos(np.arange(n)[:, None]*np.arccos(np.clip(4*x/L-1, -1, 1)))
    return out

def TA_modal(z, x, k, L, nu, sg):
    """same by the cosine series; good for z >= 0.3 L"""
    out = np.zeros((len(z), len(x))); zz = np.asarray(z)[:, None]
    for n in range(0 if sg > 0 else 1, 400, 2):
        ze = n*np.pi/L; al = np.hypot(k, ze)
        f = -((ze/al)**2*(1-al*zz)+2*nu*(k/al)**2)*np.exp(-al*zz)
        c = (2.0 if n else 1.0)/L*2      # factor 2: x on half the interval
        if n == 0: c = 2.0/L
        out += c*f*np.cos(ze*np.asarray(x))[None, :]
        if al*np.min(zz) > 45: break
    return out

def s_plate(x, ze, k, L, nu, sg):
    """sigma_zz(x, z=0)/Q of the plate under face PRESSURE Q cos(zeta z) cos(ky) (both faces, sign sigma at x=L).
    outer grid (zeta, x); scaled exponentials."""
    al = np.hypot(k, ze)[:, None]; x = np.asarray(x)[None, :]; h = L/2; c = al*h; T = h-x     # T = distance from mid-plane (x small side: +)
    e = np.exp(-2*c); Cc, Sc = (1+e)/2, (1-e)/2                      # cosh c, sinh c  / e^c
    E1, E2 = np.exp(al*(T-h)), np.exp(-al*(T+h)); Ct, St = (E1+E2)/2, (E1-E2)/2   # / e^c
    aT = al*T; r = (ze[:, None]/al)**2; q = 2*nu*(k/al)**2
    if sg > 0:
        D = c*e+Sc*Cc                                               # / e^{2c}
        num = r*((Sc-c*Cc)*Ct+aT*Sc*St)+q*Sc*Ct
    else:
        D = Sc*Cc-c*e
        small = (c < 0.15)[:, 0]
        if small.any():
            cs = c[small]; D[small] = ((2*cs)**3/12*(1+(2*cs)**2/20*(1+(2*cs)**2/42*(1+(2*cs)**2/72))))*np.exp(-2*cs)
        num = r*((Cc-c*Sc)*St+aT*Cc*Ct)+q*Cc*St
    return -num/D

def s_one(x, ze, k, nu):
    al = np.hypot(k, ze)[:, None]; ax = al*np.asarray(x)[None, :]
    return -((ze[:, None]/al)**2*(1-ax)+2*nu*(k/al)**2)*np.exp(-ax)

def TB(x, z, k, L, nu, sg, zfar=None):
    """kernel: sigma_zz^B(x,0) = int_0^inf TB(x,z) Q(z) dz = single end + sigma * other end + smooth remainder (zeta integral)"""
    x = np.asarray(x); z = np.asarray(z)
    o = np.argsort(np.concatenate([x, L-x])); xx = np.concatenate([x, L-x])[o]
    t1 = np.empty((2*len(x), len(z))); t1[o] = T1(xx, z, k, nu)
    out = t1[:len(x)]+sg*t1[len(x):]
    dz = 2*np.pi*k/120; N = int(np.ceil(45/L/dz))                    # trapezoid, alias distance 120/k
    for i0 in range(0, N, 2000):
        ze = dz*np.arange(i0, min(N, i0+2000)); w = np.full(ze.size, dz)
        if i0 == 0: w[0] *= 0.5
        ze[ze == 0] = 1e-9*k
        rem = s_plate(x, ze, k, L, nu, sg)-s_one(x, ze, k, nu)-sg*s_one(L-x, ze, k, nu)
        out += (2/np.pi)*(rem*w[:, None]).T @ np.cos(ze[:, None]*z[None, :])
    return out

def Kper(x, xs, k, L, sg):
    """periodic even half-space kernel on pairs (broadcast); both in [0,L/2]"""
    M = int(np.ceil(42/(k*L)))+1; out = 0.0
    for m in range(-M, M+1):
        out = out+sg**abs(m)*(k0(k*np.abs(x-xs-m*L))+k0(k*np.abs(x+xs-m*L)))
    return out

def Wlog(grid, xt, kern, k, sing):
    """product integration: W[i,:] @ f(nodes) = int kern(x_i,x) f(x) dx over the grid; panels subdivided towards the points sing(x_i)"""
    g, w = leggauss(10); W = np.zeros((len(xt), grid.x.size)); bx = np.exp(grid.b)
    for i, X in enumerate(xt):
        S = [s for s in sing(X)]
        nodes, wts = [], []
        pts = sorted(set(list(bx)+[s for s in S if bx[0] < s < bx[-1]]))
        stack = [(p, q) for p, q in zip(pts[:-1], pts[1:]) if q-p > 0]
        while stack:
            p, q = stack.pop(); d = min(min(abs(p-s), abs(q-s)) for s in S)
            if ((q-p) > 1.01*d and (q-p) > 1e-13*X) or k*(q-p) > 3:
                # cut: geometric towards the singular end
                sm = min(S, key=lambda s: min(abs(p-s), abs(q-s)))
                if k*(q-p) > 3: c = 0.5*(p+q)
                elif abs(p-sm) < abs(q-sm): c = p+0.25*(q-p)
                else: c = q-0.25*(q-p)
                stack += [(p, c), (c, q)]
            else:
                nodes.append(0.5*(p+q)+0.5*(q-p)*g); wts.append(0.5*(q-p)*w)
        nd = np.concatenate(nodes); wt = np.concatenate(wts)
        W[i] = (wt*kern(X, nd)) @ grid.interp(nd)
    return W

class Plate:
    """two free ends, one symmetry class"""
    def __init__(self, k, L, nu, sg, lo=1e-8, rx=2.0, rz=2.5, nx=10, nz=10):
        self.k, self.L, self.nu, self.sg = k, L, nu, sg
        s = min(L, 1/k)
        self.X = Panels(L/2*rx**(-np.arange(int(np.ceil(np.log(.5/lo)/np.log(rx))), -1, -1.0)), nx)   # breaks L/2, L/4, L/8, ... (rx=2)
        self.Z = Panels(geo(lo*s, 48/k, rz), nz)
        z1 = 0.5*L; lowz = self.Z.x < z1
        A = np.empty((self.Z.x.size, self.X.x.size))
        A[lowz] = TA(self.Z.x[lowz], self.X.x, k, L, nu, sg) if lowz.any() else 0
        if (~lowz).any(): A[~lowz] = TA_modal(self.Z.x[~lowz], self.X.x, k, L, nu, sg)
        self.A = A
        self.B = TB(self.X.x, self.Z.x, k, L, nu, sg)
        self.R = np.eye(self.Z.x.size)-(A*self.X.w) @ (self.B*self.Z.w)
        self.W = None
    def S(self, Tp):
        """P-p at the x nodes from T_A p at the z nodes"""
        return (self.B*self.Z.w) @ np.linalg.solve(self.R, Tp)
    def Wm(self, xt=None):
        xt = self.X.x if xt is None else xt; L = self.L
        return Wlog(self.X, xt, lambda X, n: Kper(X, n, self.k, L, self.sg), self.k, lambda X: (X, L-X))

class Quarter:
    """one free end at x=0, x up to 48/k"""
    def __init__(self, k, nu, lo, rx=2.0, n=10, extra=None):
        self.k, self.nu = k, nu
        br = geo(lo, 48/k, rx) if extra is None else extra
        self.X = Panels(br, n); self.Z = self.X
        self.A = T1(self.Z.x, self.X.x, k, nu); self.B = self.A       # T_B(x,z) = T1(depth x, source z): same matrix
        self.R = np.eye(self.X.x.size)-(self.A*self.X.w) @ (self.B*self.Z.w)
    def S(self, Tp): return (self.B*self.Z.w) @ np.linalg.solve(self.R, Tp)
    def Wm(self, xt):
        return Wlog(self.X, xt, lambda X, n: k0(self.k*np.abs(X-n))+k0(self.k*(X+n)), self.k, lambda X: (X,))
