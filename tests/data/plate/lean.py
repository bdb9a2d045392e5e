"""LEAN version, meant to be ported: Legendre coefficients  Dhat_ab(kL,nu)  of  (exact two-end - superposed single-end) operator.
   D(x,x') = sum_ab phi_a(x) Dhat_ab phi_b(x'),  phi_a = sqrt((2a+1)/L) P_a(2x/L-1) orthonormal on [0,L],  a+b even (else 0).
Trapezoid rules only: x = L/(1+exp(-t)) (log-graded at both ends), z = exp(s).  Unknowns: Q at the z nodes, per class."""
import os; os.environ.setdefault('OMP_NUM_THREADS','1')
import numpy as np, time
from numpy.polynomial import legendre as Lg
from scipy.special import k0
from plate import T1, TA, TA_modal, s_plate, s_one
TRAP=70.0
def phi(a, x, L): return np.sqrt((2*a+1)/L)*Lg.legval(2*x/L-1, np.eye(a+1)[a])
def xhalf(L, h, lo):
    """nodes/weights of int_0^{L/2}: t=0 carries half its weight"""
    n = int(np.ceil(-np.log(lo)/h)); t = -h*np.arange(n, -1, -1.0); x = L*np.exp(t)/(1+np.exp(t)); w = h*x*(L-x)/L; w[-1] /= 2
    return x, w
def xall(L, h, lo):
    x, w = xhalf(L, h, lo); w = w.copy(); return x, w
def zgrid(lo, hi, h):
    n = int(np.ceil(np.log(hi/lo)/h)); z = hi*np.exp(h*(np.arange(-n, 1.0))); return z, h*z
def TB_lean(x, z, k, L, nu, sg):
    o = np.argsort(np.concatenate([x, L-x]), kind='stable'); xx = np.concatenate([x, L-x])[o]
    xx = xx+np.arange(len(xx))*1e-14*L
    t1 = np.empty((2*len(x), len(z))); t1[o] = T1(xx, z, k, nu); out = t1[:len(x)]+sg*t1[len(x):]
    dz = 2*np.pi*k/TRAP; N = int(np.ceil(35/L/dz))+1; ze = dz*np.arange(N); ze[0] = 1e-9*k; w = np.full(N, dz); w[0] /= 2
    rem = s_plate(x, ze, k, L, nu, sg)-s_one(x, ze, k, nu)-sg*s_one(L-x, ze, k, nu)
    return out+(2/np.pi)*(rem*w[:, None]).T @ np.cos(ze[:, None]*z[None, :])
def Kquad(x, A, k, L, n=24, images=False, sg=1):
    """int_0^L [K0(k|x-x'|)+K0(k(x+x'))] phi_a(x') dx' for a in A at points x (also x>L), split at x, double-exponential nodes.
    images=True: the full periodic even kernel instead"""
    t = np.linspace(-3.2, 3.2, 2*n+1); dt = t[1]-t[0]; e = np.exp(np.pi*np.sinh(t)); y = e/(1+e); yc = 1/(1+e); wy = dt*np.pi*np.cosh(t)*y*yc
    out = np.zeros((len(x), len(A))); M = int(np.ceil(42/(k*L)))+1
    for i, X in enumerate(x):
        segs = [(0, X), (X, L)] if X < L else [(0, L)]
        for p, q in segs:
            ln = q-p; xs = p+ln*y
            d = ln*yc if q == X else (ln*y if p == X else np.maximum(X-xs, (X-L)+ln*yc))   # |X-xs| without cancellation
            K = k0(k*np.maximum(d, 1e-290))+k0(k*(X+xs))
            out[i] += np.array([(K*wy*ln) @ phi(a, xs, L) for a in A])
    if images:                                           # images at distance >= L/2: plain Gauss (x <= L/2 only)
        g, w = Lg.leggauss(24); xg = L/2*(1+g); P = np.array([phi(a, xg, L) for a in A]).T*(L/2*w)[:, None]; x = np.asarray(x)[:, None]
        out += sum(k0(k*(2*m*L+s)) for m in range(1, M+1) for s in (x-xg, xg-x, x+xg, -x-xg)) @ P
    return out
_q = {}
def quarter(k, nu, h, lo):
    key = (nu, h, lo)
    if key not in _q:                                    # once per nu, k=1
        x, w = zgrid(lo, 40.0, h); T = T1(x, x, 1.0, nu); _q[key] = (x, w, T, np.linalg.inv(np.eye(len(x))-(T*w) @ (T*w)))
    return _q[key]
def Dhat(kL, nu, deg=7, h=0.4, lo=1e-7, hz=None, parts=False):
    k, L = kL, 1.0; hz = hz or h; out = np.zeros((deg+1, deg+1)); X1, w1, T, inv = quarter(k, nu, hz, lo)
    # single end, source phi_a on [0,L]: T1 phi_a at depth z; x-quadrature log-graded at both ends (all of [0,L])
    xh, wh = xhalf(L, h, lo); xf = np.concatenate([xh, (L-xh)[::-1]]); wf = np.concatenate([wh, wh[::-1]])
    A = list(range(deg+1)); F = np.array([phi(a, xf, L) for a in A]).T
    o = slice(None)
    zq = X1/k; f1 = T1(zq, xf, k, nu) @ (wf[:, None]*F)               # (nz, a)
    # S1(x) = T (I-TT)^-1 f1, taken at x nodes graded towards 0, L (both sides): K1 phi has a kink (x-L) ln|x-L| at L
    y, wy = zgrid(lo*min(L, 1/k), 40/k, h); xe = np.concatenate([xf, L+y]); we = np.concatenate([wf, wy])
    o = np.argsort(xe, kind='stable'); xe, we = xe[o]+1e-15*np.arange(len(xe)), we[o]
    S1 = (T1(xe, zq, k, nu)*(w1/k)) @ (inv @ f1)
    C1 = Kquad(xe, A, k, L).T @ (we[:, None]*S1); C1 = .5*(C1+C1.T)     # <phi_b, corr1 phi_a>, end 0
    z, wz = zgrid(lo*min(L, 1/k), 40/k, hz)
    for sg in (1, -1):
        Ai = [a for a in A if a % 2 == (0 if sg > 0 else 1)]; Fi = F[:len(xh)][:, Ai]
        TAm = np.empty((len(z), len(xh))); l = z < .4*L
        if l.any(): TAm[l] = TA(z[l], xh, k, L, nu, sg)
        if (~l).any(): TAm[~l] = TA_modal(z[~l], xh, k, L, nu, sg)
        B = TB_lean(xh, z, k, L, nu, sg)
        Q = np.linalg.solve(np.eye(len(z))-(TAm*wh) @ (B*wz), TAm @ (wh[:, None]*Fi))
        S = (B*wz) @ Q
        KP = Kquad(xh, Ai, k, L, images=True)
        E = 2*KP.T @ (wh[:, None]*S); E = .5*(E+E.T)                   # S-part of the exact operator
        sup = 2*C1[np.ix_(Ai, Ai)]                                    # two ends (same by symmetry)
        out[np.ix_(Ai, Ai)] = E-sup
    # remaining images: Gauss x Gauss
    g, w = Lg.leggauss(24); xg = L/2*(1+g); wg = L/2*w; G = np.array([phi(a, xg, L) for a in A]).T*wg[:, None]
    Kr = 0.0; M = int(np.ceil(42/k/L))+1; a, b = xg[:, None], xg[None, :]
    for m in range(1, M+1):
        for s in (a-b, b-a, a+b, -a-b):
            if m == 1 and s is not None and np.allclose(s, -a-b): continue      # 2L-x-x' = the far mirror, in the superposition
            Kr = Kr+k0(k*(2*m*L+s))
    out += G.T @ Kr @ G
    return (out, len(z), len(xh), len(X1)) if parts else out
if __name__ == '__main__':
    from diff import diffkernel
    for nu in (.3,):
      for kL in (.3, 1., 4.):
        ref = np.zeros((8, 8))
        for sg in (1, -1):
            r = diffkernel(kL, 1.0, nu, sg); D = r['D'][1:, 1:]; idx = [a for a in range(8) if a % 2 == (0 if sg > 0 else 1)]
            V = np.array([phi(a, r['xs'], 1.0)*r['ws'] for a in idx]).T; ref[np.ix_(idx, idx)] = 2*V.T @ D @ V
        U = 1.2*np.pi/kL
        for h, lo in ((.25, 1e-9), (.4, 1e-7), (.5, 1e-6), (.6, 1e-5), (.8, 1e-5), (.8, 1e-4), (1., 1e-3)):
            quarter(kL, nu, h, lo); t = time.time(); d, nz, nx, nq = Dhat(kL, nu, h=h, lo=lo, parts=True); t = time.time()-t
            print(kL, nu, 'h', h, 'lo', lo, 'nz', nz, 'nx', nx, 'nq', nq, 'err/U', f'{np.abs(d-ref).max()/U:.1e}', 'max|D|/U', f'{np.abs(ref).max()/U:.1e}', 't', round(t, 3), flush=True)
